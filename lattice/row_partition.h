#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <mpi.h>

#include "lattice/triangular_lattice.h"
#include "lattice/zero_pages.h"

namespace latcon::lattice
{

/// A field over the places of a lattice, one value each, margin included. Make one of zeros as Field(n): see ZeroPages.
using Field = std::vector<double, ZeroPages<double>>;
/// A small whole number per place.
using SiteFlags = std::vector<std::uint8_t, ZeroPages<std::uint8_t>>;

/// The rows begin, begin + 1, ... end - 1.
struct Rows
{
  std::size_t begin, end;
};

/// Places of sites, a list for each rank.
using SitesOfRanks = std::vector<std::vector<std::size_t>>;

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
  /// All rows. The lattice must outlive this object.
  RowPartition(const TriangularLattice &lattice); // NOLINT(google-explicit-constructor)

  /// The share of the calling process in `communicator`. Bands differ by one row at most.
  RowPartition(const TriangularLattice &lattice, MPI_Comm communicator);

  const TriangularLattice &lattice() const { return *lattice_; }
  Rows rows() const { return {first_rows_[rank_], first_rows_[rank_ + 1]}; } ///< that this rank moves
  bool owns(std::size_t place) const; ///< whether a place, margin included, is in one of its rows
  bool is_relevant(std::size_t place) const { return is_relevant_[padded_row(place)] != 0; } ///< or in its halo
  /// Returns whether a site of a sheet that is not periodic is in a row of a rank or in its halo.
  bool is_relevant_to(std::size_t rank, std::size_t place) const;
  std::vector<std::size_t> known_rows() const; ///< own ones and halo, by increasing number

  bool is_first() const { return rank_ == 0; } ///< whether this is the first rank, which gathers
  bool is_shared() const { return n_ranks() > 1; }
  std::size_t rank() const { return rank_; }
  std::size_t n_ranks() const { return first_rows_.size() - 1; }
  MPI_Comm communicator() const { return communicator_; }
  std::size_t owner(std::size_t row) const; ///< rank that moves a row
  std::vector<std::size_t> halo_of(std::size_t rank) const; ///< rows of others that a rank needs, by increasing number
  /// Places in its rows that others have in their halos, or places in its own halo, for exchange().
  SitesOfRanks halo_sites(bool own) const;

  /// Sum of the values of all rows from the lowest up, whoever has them: the same bits for any number of ranks.
  /// Collective. @param values one a row of the sheet; those of own rows are read
  double sum(const std::vector<double> &values) const;

  /// The lists of all ranks one after the other. Collective; costs one short message where all lists are empty.
  /// @param number in: of this rank, out: the largest over all ranks, sent with the same message; nullptr: none
  template <class T>
  std::vector<T> all_gather(const std::vector<T> &own, int *number = nullptr) const;

  /// Sends the values of `fields` at own sites and receives those at sites of other ranks. Collective among ranks that
  /// exchange sites. @param sent,received of two ranks the same sites in the same order
  void exchange(const SitesOfRanks &sent, const SitesOfRanks &received, const std::vector<Field *> &fields) const;

  /// Gives the first rank the values in `rows`, margin of columns included. Collective.
  template <class Vector>
  void gather(Vector &field, Rows rows) const;

private:
  std::size_t padded_row(std::size_t place) const { return place / lattice_->stride(); }
  std::vector<char> all_gather_bytes(const char *own, std::size_t size, int *number) const;
  void gather_bytes(void *field, std::size_t bytes_of_place, Rows rows) const;

  const TriangularLattice *lattice_;
  MPI_Comm communicator_;
  std::size_t rank_;
  std::vector<std::size_t> first_rows_;   // of each rank, and the number of rows
  std::vector<std::uint8_t> is_relevant_; // by row with margin
};

template <class T>
std::vector<T> RowPartition::all_gather(const std::vector<T> &own, int *number) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  if (!is_shared())
    return own;
  const std::vector<char> bytes =
    all_gather_bytes(reinterpret_cast<const char *>(own.data()), own.size() * sizeof(T), number);
  std::vector<T> all(bytes.size() / sizeof(T));
  // Not memcpy, which may not be given the null pointers of empty vectors.
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(all.data()));
  return all;
}

template <class Vector>
void RowPartition::gather(Vector &field, Rows rows) const
{
  if (is_shared())
    gather_bytes(field.data(), sizeof(typename Vector::value_type), rows);
}

} // namespace latcon::lattice
