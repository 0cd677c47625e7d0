#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <vector>

#include <boost/container/flat_set.hpp>
#include <mpi.h>

#include "lattice/triangular_lattice.h"
#include "support/zero_pages.h"

namespace latcon::lattice
{

/// A field over the places of a lattice, one value each, margin included. Make one of zeros as Field(n): see ZeroPages.
using Field = std::vector<double, support::ZeroPages<double>>;
/// A small whole number per place.
using SiteFlags = std::vector<std::uint8_t, support::ZeroPages<std::uint8_t>>;

/// Places of sites for each rank.
using SitesOfRanks = std::vector<boost::container::flat_set<std::size_t>>;

/// The rows of a sheet that one process moves, as one of the ranks that share the sheet or alone.
///
/// Every rank has a band of rows that follow each other, the lowest rank the lowest rows, none at all if there are more
/// ranks than rows. Bonds reach some rows up and down, so besides its own a rank keeps the rows of a halo up to date,
/// as many on either side, across a periodic edge as well. Own rows and halo are the rows that it knows. Places are
/// those of the whole sheet on every rank.
///
/// A lattice converts to the band of all its rows, for which nothing is communicated and MPI need not be running. Where
/// a function is said to be collective, all ranks must call it.
class RowPartition
{
public:
  /// @param lattice must outlive this object
  /// @param communicator of which the calling process has a share; bands differ by one row at most. Null: all rows
  RowPartition(const TriangularLattice &lattice, // NOLINT(google-explicit-constructor)
               MPI_Comm communicator = MPI_COMM_NULL);

  const TriangularLattice &lattice() const { return *lattice_; }
  Rows rows() const { return rows_of(rank_); } ///< that this rank moves
  /// Returns whether a place, margin of columns included, is in one of its rows.
  bool owns(std::size_t place) const { return place >= own_.begin && place < own_.end; }
  /// Returns whether a place in a row of the sheet is in its rows or in its halo.
  bool is_relevant(std::size_t place) const { return is_relevant_[lattice_->row_of(place)] != 0; }
  /// Places of the sites in own rows and halo, row by row.
  std::vector<std::size_t> known_sites() const;
  /// Own rows and halo, by increasing number.
  std::vector<std::size_t> known_rows() const { return rows_around(rank_, lattice_->reach()); }
  /// Own rows and those below from which bonds reach into them, by increasing number.
  std::vector<std::size_t> rows_of_bonds() const { return rows_around(rank_, 0); }

  bool is_first() const { return rank_ == 0; } ///< whether this is the first rank, which gathers
  bool is_shared() const { return n_ranks_ > 1; }
  std::size_t n_ranks() const { return n_ranks_; }
  MPI_Comm communicator() const { return communicator_; }
  /// Rank that moves a row.
  std::size_t owner(std::size_t row) const { return ((row + 1) * n_ranks_ - 1) / lattice_->rows(); }
  /// Places in its rows that others have in their halos, or places in its own halo, for exchange().
  SitesOfRanks halo_sites(bool own) const;

  /// Values of all rows, whoever has them. Collective. @param values one a row of the sheet; those of own rows are read
  std::vector<double> all_rows(const std::vector<double> &values) const
  {
    return all_gather(std::vector<double>(&values[0] + rows().begin, &values[0] + rows().end));
  }
  /// Their sum from the lowest row up: the same bits for any number of ranks. Collective.
  double sum(const std::vector<double> &values) const
  {
    const std::vector<double> all = all_rows(values);
    return std::accumulate(all.begin(), all.end(), 0.);
  }

  /// The lists of all ranks one after the other. Collective; costs one short message where all lists are empty.
  /// @param number in: of this rank, out: the largest over all ranks, sent with the same message; nullptr: none
  template <class T>
  std::vector<T> all_gather(const std::vector<T> &own, int *number = nullptr) const;

  /// Sends the values of `fields` at own sites and receives those at sites of other ranks. Collective among ranks that
  /// exchange sites. @param sent,received of two ranks the same sites
  void exchange(const SitesOfRanks &sent, const SitesOfRanks &received, const std::vector<Field *> &fields) const;

  /// Gives the first rank the values in `rows`, margin of columns included. Collective.
  template <class Vector>
  void gather(Vector &field, Rows rows) const;

private:
  Rows rows_of(std::size_t rank) const
  {
    return {lattice_->rows() * rank / n_ranks_, lattice_->rows() * (rank + 1) / n_ranks_};
  }
  /// Rows of a rank, as many below them as bonds reach, and so many above them; none if it has no rows.
  std::vector<std::size_t> rows_around(std::size_t rank, std::size_t above) const;

  const TriangularLattice *lattice_;
  MPI_Comm communicator_;
  std::size_t rank_ = 0, n_ranks_ = 1;
  Rows own_;                              // places
  std::vector<std::uint8_t> is_relevant_; // by row
};

template <class T>
std::vector<T> RowPartition::all_gather(const std::vector<T> &own, int *number) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  if (!is_shared())
    return own;
  const std::array<int, 2> given{static_cast<int>(own.size() * sizeof(T)), number != nullptr ? *number : 0};
  std::vector<std::array<int, 2>> all_given(n_ranks());
  MPI_Allgather(given.data(), 2, MPI_INT, all_given.data(), 2, MPI_INT, communicator_);
  std::vector<int> sizes, offsets; // in bytes
  int end = 0;
  for (const auto &[of_size, of_number] : all_given)
  {
    sizes.push_back(of_size);
    offsets.push_back(end);
    end += of_size;
    if (number != nullptr)
      *number = std::max(*number, of_number);
  }
  std::vector<T> all(static_cast<std::size_t>(end) / sizeof(T));
  if (!all.empty())
    MPI_Allgatherv(own.data(), given[0], MPI_CHAR, all.data(), sizes.data(), offsets.data(), MPI_CHAR, communicator_);
  return all;
}

template <class Vector>
void RowPartition::gather(Vector &field, Rows rows) const
{
  if (!is_shared())
    return;
  // In units of a row: so the numbers fit into MPI's integers.
  const std::size_t bytes = sizeof(typename Vector::value_type) * lattice_->stride();
  MPI_Datatype row_type = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &row_type);
  MPI_Type_commit(&row_type);
  std::vector<int> counts, offsets;
  for (std::size_t r = 0; r < n_ranks(); ++r)
  {
    const auto [begin, end] = rows_of(r);
    offsets.push_back(static_cast<int>(std::clamp(begin, rows.begin, rows.end) + lattice_->reach()));
    counts.push_back(static_cast<int>(std::clamp(end, rows.begin, rows.end) + lattice_->reach()) - offsets.back());
  }
  void *const own = &field[static_cast<std::size_t>(offsets[rank_]) * lattice_->stride()];
  MPI_Gatherv(is_first() ? MPI_IN_PLACE : own, counts[rank_], row_type, field.data(), counts.data(), offsets.data(),
              row_type, 0, communicator_);
  MPI_Type_free(&row_type);
}

} // namespace latcon::lattice
