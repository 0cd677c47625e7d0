#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "lattice/row_partition.h"
#include "support/require.h"

namespace latcon::lattice
{

/// Saves a field over the sites of a lattice, or loads it: row by row, so that the list is the same for any number of
/// ranks. Collective. `archive` is what classes that have a member function archive() are given; see Simulation.
/// @param rows that a rank takes when it loads
template <class Archive, class Vector>
void archive_rows(Archive &archive, const std::string &name, Vector &field, const RowPartition &band,
                  const std::vector<std::size_t> &rows)
{
  const TriangularLattice &lattice = band.lattice();
  std::vector<typename Vector::value_type> values;
  if constexpr (!Archive::loads)
  {
    band.gather(field, {0, lattice.rows()});
    if (band.is_first())
      for (const std::size_t place : lattice.sites())
        values.push_back(field[place]);
  }
  archive(name, values);
  if constexpr (Archive::loads)
  {
    support::require(values.size() == lattice.n_sites(), "`" + name + "` is of a sheet of another size");
    for (const std::size_t row : rows)
      for (const std::size_t place : lattice.sites({row, row + 1}))
        field[place] = values[lattice.site_number(place)];
  }
}

/// Archive in memory of all that a Simulation archives, on each rank of the rows that it knows.
class Snapshot
{
public:
  bool empty() const { return chunks_.empty(); } ///< whether nothing was saved

  /// Archive that saves to a snapshot or loads from it: the same values in the same order, without communication.
  template <bool is_loading>
  class Archive
  {
  public:
    static constexpr bool loads = is_loading;
    using Stored = std::conditional_t<is_loading, const Snapshot, Snapshot>;
    explicit Archive(Stored &snapshot) : snapshot_(snapshot) {}

    /// Archives a number, an optional number, a vector of numbers whose size does not change, or an object with
    /// archive(). @throws std::invalid_argument to load from a snapshot of another simulation
    template <class T>
    void operator()(const std::string & /*name*/, T &value)
    {
      if constexpr (std::is_trivially_copyable_v<T>)
        values(&value, 1);
      else
        value.archive(*this);
    }
    template <class T, class Allocator>
    void operator()(const std::string & /*name*/, std::vector<T, Allocator> &value)
    {
      values(value.data(), value.size());
    }

    /// Archives n numbers. @throws std::invalid_argument as above
    template <class T>
    void values(T *first, std::size_t n)
    {
      static_assert(std::is_trivially_copyable_v<T>);
      auto &chunks = snapshot_.chunks_;
      if constexpr (loads)
      {
        support::require(n_chunks_ < chunks.size() && chunks[n_chunks_].size() == n * sizeof(T),
                         "the snapshot is of another simulation");
        std::copy(chunks[n_chunks_].begin(), chunks[n_chunks_].end(), reinterpret_cast<char *>(first));
      }
      else
      {
        // Memory of an earlier snapshot is used again.
        chunks.resize(std::max(chunks.size(), n_chunks_ + 1));
        const char *const bytes = reinterpret_cast<const char *>(first);
        chunks[n_chunks_].assign(bytes, bytes + n * sizeof(T));
      }
      ++n_chunks_;
    }

  private:
    Stored &snapshot_;
    std::size_t n_chunks_ = 0; // saved or loaded so far
  };

private:
  std::vector<std::vector<char>> chunks_; // one per call of Archive::values()
};

/// Saves a field in `rows`, or loads it, with the margin of columns: loops over rows work on some places of it, which
/// may not keep values that are not finite.
template <bool loads, class Vector>
void archive_rows(Snapshot::Archive<loads> &archive, const std::string & /*name*/, Vector &field,
                  const RowPartition &band, const std::vector<std::size_t> &rows)
{
  const TriangularLattice &lattice = band.lattice();
  for (const std::size_t row : rows)
    archive.values(&field[lattice.index(row, 0) / lattice.stride() * lattice.stride()], lattice.stride());
}

} // namespace latcon::lattice
