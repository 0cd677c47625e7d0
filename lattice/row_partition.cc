#include "lattice/row_partition.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace latcon::lattice
{
namespace
{

// Tag of messages between two ranks, which arrive in the order in which they are sent.
constexpr int tag = 0;

} // namespace

RowPartition::RowPartition(const TriangularLattice &lattice)
  : lattice_(&lattice), communicator_(MPI_COMM_NULL), rank_(0), first_rows_{0, lattice.rows()},
    is_relevant_(lattice.n_places() / lattice.stride(), 1)
{
}

RowPartition::RowPartition(const TriangularLattice &lattice, MPI_Comm communicator)
  : lattice_(&lattice), communicator_(communicator), rank_(0), is_relevant_(lattice.n_places() / lattice.stride(), 0)
{
  int rank = 0, n_ranks = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  rank_ = static_cast<std::size_t>(rank);
  const auto n = static_cast<std::size_t>(n_ranks);
  for (std::size_t i = 0; i <= n; ++i)
    first_rows_.push_back(lattice.rows() * i / n);
  for (const std::size_t row : known_rows())
    is_relevant_[padded_row(lattice.index(row, 0))] = 1;
}

std::vector<std::size_t> RowPartition::known_rows() const
{
  std::vector<std::size_t> known = halo_of(rank_);
  for (std::size_t row = rows().begin; row < rows().end; ++row)
    known.push_back(row);
  std::sort(known.begin(), known.end());
  return known;
}

bool RowPartition::owns(std::size_t place) const
{
  const Rows own = rows();
  const std::size_t row = lattice_->row_of(place); // beyond all rows where the margin is below them
  return row >= own.begin && row < own.end;
}

std::size_t RowPartition::owner(std::size_t row) const
{
  return static_cast<std::size_t>(std::upper_bound(first_rows_.begin(), first_rows_.end(), row) - first_rows_.begin()) -
         1;
}

std::vector<std::size_t> RowPartition::halo_of(std::size_t rank) const
{
  const auto begin = static_cast<std::ptrdiff_t>(first_rows_[rank]);
  const auto end = static_cast<std::ptrdiff_t>(first_rows_[rank + 1]);
  const auto reach = static_cast<std::ptrdiff_t>(lattice_->reach());
  std::vector<std::size_t> halo;
  if (begin == end)
    return halo;
  const auto add = [&](std::ptrdiff_t number)
  {
    const auto row = lattice_->row(number);
    if (row && owner(*row) != rank)
      halo.push_back(*row);
  };
  for (std::ptrdiff_t distance = 0; distance < reach; ++distance)
  {
    add(begin - reach + distance);
    add(end + distance);
  }
  std::sort(halo.begin(), halo.end());
  halo.erase(std::unique(halo.begin(), halo.end()), halo.end());
  return halo;
}

SitesOfRanks RowPartition::halo_sites(bool own) const
{
  SitesOfRanks sites(n_ranks());
  for (std::size_t rank = 0; rank < n_ranks(); ++rank)
    for (const std::size_t row : halo_of(own ? rank : rank_))
      if (owner(row) == (own ? rank_ : rank))
        for (std::size_t column = 0; column < lattice_->columns(); ++column)
          sites[rank].push_back(lattice_->index(row, column));
  return sites;
}

bool RowPartition::is_relevant_to(std::size_t rank, std::size_t place) const
{
  const std::size_t begin = first_rows_[rank], end = first_rows_[rank + 1], row = lattice_->row_of(place);
  return begin < end && row + lattice_->reach() >= begin && row < end + lattice_->reach();
}

double RowPartition::sum(const std::vector<double> &values) const
{
  const std::vector<double> all = all_gather(std::vector<double>(&values[0] + rows().begin, &values[0] + rows().end));
  return std::accumulate(all.begin(), all.end(), 0.);
}

std::vector<char> RowPartition::all_gather_bytes(const char *own, std::size_t size, int *number) const
{
  const int own_size = static_cast<int>(size);
  const std::array<int, 2> given{own_size, number != nullptr ? *number : 0};
  std::vector<std::array<int, 2>> all_given(n_ranks());
  MPI_Allgather(given.data(), 2, MPI_INT, all_given.data(), 2, MPI_INT, communicator_);
  std::vector<int> sizes, offsets(n_ranks(), 0);
  for (const auto &[of_size, of_number] : all_given)
  {
    sizes.push_back(of_size);
    if (number != nullptr)
      *number = std::max(*number, of_number);
  }
  std::partial_sum(sizes.begin(), sizes.end() - 1, offsets.begin() + 1);
  std::vector<char> all(static_cast<std::size_t>(offsets.back() + sizes.back()));
  if (!all.empty())
    MPI_Allgatherv(own, own_size, MPI_CHAR, all.data(), sizes.data(), offsets.data(), MPI_CHAR, communicator_);
  return all;
}

void RowPartition::exchange(const SitesOfRanks &sent, const SitesOfRanks &received,
                            const std::vector<Field *> &fields) const
{
  if (!is_shared())
    return;
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

void RowPartition::gather_bytes(void *field, std::size_t bytes_of_place, Rows rows) const
{
  // In units of a row: so the numbers fit into MPI's integers.
  const std::size_t bytes = bytes_of_place * lattice_->stride();
  MPI_Datatype row_type = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &row_type);
  MPI_Type_commit(&row_type);
  std::vector<int> counts, offsets;
  for (std::size_t r = 0; r < n_ranks(); ++r)
  {
    const std::size_t begin = std::clamp(first_rows_[r], rows.begin, rows.end);
    offsets.push_back(static_cast<int>(padded_row(lattice_->index(begin, 0))));
    counts.push_back(static_cast<int>(std::clamp(first_rows_[r + 1], rows.begin, rows.end) - begin));
  }
  if (is_first())
    MPI_Gatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, field, counts.data(), offsets.data(), row_type, 0, communicator_);
  else
    MPI_Gatherv(static_cast<char *>(field) + static_cast<std::size_t>(offsets[rank_]) * bytes, counts[rank_], row_type,
                nullptr, nullptr, nullptr, row_type, 0, communicator_);
  MPI_Type_free(&row_type);
}

} // namespace latcon::lattice
