#pragma once

#include "continuum/damage/grid_damage.h"

#include <cstddef>
#include <vector>

#include <mpi.h>

namespace latcon::continuum
{
/// Division of a grid into bands of rows, one per rank. Every rank holds the values of all rows; it computes those of
/// its own band and gets the others from their owners, so that all ranks have the bits that one rank computes.
class RowBands
{
public:
  /// Divides the rows of nodes of a grid as evenly as possible. Row j of cells belongs to the owner of row j of nodes.
  /// Collective; MPI_COMM_SELF needs no MPI. Throws InvalidInput, on all ranks, if there are more ranks than rows of
  /// nodes.
  RowBands(const NodeGrid &grid, MPI_Comm communicator);

  /// Own rows of nodes, [begin, end).
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  /// Own rows of cells, [begin, cells_end).
  std::size_t cells_end() const { return end_ < rows_ ? end_ : rows_ - 1; }

  /// Replaces the values of rows of other ranks by those of their owners. `values` has the same number of values for
  /// each row of nodes or of cells, in the order of the rows. Collective.
  void gather_nodes(std::vector<double> &values) const { gather(values, rows_); }
  void gather_cells(std::vector<double> &values) const { gather(values, rows_ - 1); }

private:
  void gather(std::vector<double> &values, std::size_t n_rows) const;

  MPI_Comm communicator_;
  int rank_ = 0, n_ranks_ = 1;
  std::size_t rows_, begin_ = 0, end_;
};
} // namespace latcon::continuum
