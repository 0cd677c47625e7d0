#pragma once

#include "lattice/state.h"

namespace lattice
{

/// Calls operation(begin, end) with the places of each row, rows being shared out among threads. For operations that
/// couple no two sites, whose bits then cannot depend on how.
template <class RowOperation>
void for_each_row(const TriangularLattice &lattice, const RowOperation &operation)
{
  const auto n_rows = static_cast<std::ptrdiff_t>(lattice.rows());
#pragma omp parallel for schedule(static) if (lattice.n_places() >= worth_threads)
  for (std::ptrdiff_t row = 0; row < n_rows; ++row)
  {
    const std::size_t first = lattice.index(static_cast<std::size_t>(row), 0);
    operation(first, first + lattice.columns());
  }
}

} // namespace lattice
