#include "lattice/bond_history.h"

#include <algorithm>

namespace latcon::lattice
{

std::vector<std::size_t> BondHistory::rows(const RowPartition &band)
{
  constexpr std::size_t reach = 2; // of bonds, in rows
  const TriangularLattice &lattice = band.lattice();
  const Rows own = band.rows();
  std::vector<std::size_t> rows;
  for (std::size_t row = own.begin; row < own.end; ++row)
    rows.push_back(row);
  if (rows.empty())
    return rows;
  const bool repeats = lattice.is_occupied(lattice.index(0, 0) - lattice.stride());
  for (std::size_t distance = 1; distance <= reach; ++distance)
    if (own.begin >= distance)
      rows.push_back(own.begin - distance);
    else if (repeats)
      rows.push_back(lattice.rows() + own.begin - distance);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

} // namespace latcon::lattice
