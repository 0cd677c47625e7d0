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
  /// Collective.
  explicit CellOrder(const Sheet &sheet);

  /// Gathers lists of values of equal length for each locally owned cell, in the order of their iteration, on the root
  /// rank; returns an empty list on other ranks. Collective.
  std::vector<double> gather(const std::vector<double> &own) const;

  /// Returns the values of the locally owned cells from the complete list, which must be the same on every rank. Throws
  /// InvalidInput on every rank if the list does not have `n_per_cell` values for each cell.
  std::vector<double> scatter(const std::vector<double> &all, std::size_t n_per_cell) const;

private:
  MPI_Comm communicator_;
  std::size_t n_cells_;                // of all ranks
  std::vector<unsigned int> position_; // in the order, of each locally owned cell
};
} // namespace latcon::continuum
