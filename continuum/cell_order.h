#pragma once

#include "continuum/sheet.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// Order of the cells of a sheet that does not depend on the partition of the mesh: that of their names in the
/// refinement tree. Values at quadrature points saved on some number of ranks can thus be loaded on any other. Valid
/// until the mesh changes.
class CellOrder
{
public:
  /// Creates the order for lists of `n_values` values per locally owned cell, in the order of their iteration.
  /// Collective.
  CellOrder(const Sheet &sheet, const std::vector<std::size_t> &n_values);

  /// Gathers the lists of the locally owned cells on the root rank; returns an empty list on other ranks. Collective.
  std::vector<double> gather(const std::vector<double> &own) const;

  /// Returns the values of the locally owned cells from the complete list, which must be the same on every rank. Throws
  /// InvalidInput on every rank if the list does not have the values of all cells.
  std::vector<double> scatter(const std::vector<double> &all) const;

private:
  // Values of a locally owned cell.
  struct Range
  {
    std::size_t begin, size; // in the complete list

    template <class Archive>
    void serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &begin &size;
    }
  };

  MPI_Comm communicator_;
  std::size_t n_values_ = 0;  // of all cells
  std::vector<Range> ranges_; // of each locally owned cell
};
} // namespace latcon::continuum
