#include "lattice/row_partition.h"

#include <set>

namespace latcon::lattice
{

RowPartition::RowPartition(const TriangularLattice &lattice, MPI_Comm communicator)
  : lattice_(&lattice), communicator_(communicator), is_relevant_(lattice.rows(), 0)
{
  if (communicator != MPI_COMM_NULL)
  {
    int rank = 0, n_ranks = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);
    rank_ = static_cast<std::size_t>(rank);
    n_ranks_ = static_cast<std::size_t>(n_ranks);
  }
  own_ = {(rows().begin + lattice.reach()) * lattice.stride(), (rows().end + lattice.reach()) * lattice.stride()};
  for (const std::size_t row : known_rows())
    is_relevant_[row] = 1;
}

std::vector<std::size_t> RowPartition::known_sites() const
{
  std::vector<std::size_t> sites;
  for (const std::size_t row : known_rows())
    for (const std::size_t place : lattice_->sites({row, row + 1}))
      sites.push_back(place);
  return sites;
}

std::vector<std::size_t> RowPartition::rows_around(std::size_t rank, std::size_t above) const
{
  const auto [begin, end] = rows_of(rank);
  std::set<std::size_t> rows;
  if (begin < end)
    for (std::size_t number = begin - lattice_->reach(); number != end + above; ++number) // modulo 2^64
      if (const auto row = lattice_->row(static_cast<std::ptrdiff_t>(number)))
        rows.insert(*row);
  return {rows.begin(), rows.end()};
}

SitesOfRanks RowPartition::halo_sites(bool own) const
{
  SitesOfRanks sites(n_ranks_);
  for (std::size_t rank = 0; rank < n_ranks_; ++rank)
    for (const std::size_t row : rows_around(own ? rank : rank_, lattice_->reach()))
      if (rank != rank_ && owner(row) == (own ? rank_ : rank))
        for (std::size_t column = 0; column < lattice_->columns(); ++column)
          sites[rank].insert(lattice_->index(row, column));
  return sites;
}

void RowPartition::exchange(const SitesOfRanks &sent, const SitesOfRanks &received,
                            const std::vector<Field *> &fields) const
{
  if (!is_shared())
    return;
  constexpr int tag = 0; // messages between two ranks arrive in the order in which they are sent
  std::vector<MPI_Request> requests;
  std::vector<std::vector<double>> in(received.size()), out(sent.size());
  for (std::size_t rank = 0; rank < received.size(); ++rank)
    if (!received[rank].empty())
    {
      in[rank].resize(received[rank].size() * fields.size());
      MPI_Irecv(in[rank].data(), static_cast<int>(in[rank].size()), MPI_DOUBLE, static_cast<int>(rank), tag,
                communicator_, &requests.emplace_back());
    }
  for (std::size_t rank = 0; rank < sent.size(); ++rank)
    if (!sent[rank].empty())
    {
      for (const std::size_t place : sent[rank])
        for (const Field *field : fields)
          out[rank].push_back((*field)[place]);
      MPI_Isend(out[rank].data(), static_cast<int>(out[rank].size()), MPI_DOUBLE, static_cast<int>(rank), tag,
                communicator_, &requests.emplace_back());
    }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (std::size_t rank = 0; rank < received.size(); ++rank)
  {
    auto value = in[rank].begin();
    for (const std::size_t place : received[rank])
      for (Field *field : fields)
        (*field)[place] = *value++;
  }
}

} // namespace latcon::lattice
