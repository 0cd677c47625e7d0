#include "lattice/bond_history.h"

#include <algorithm>

namespace latcon::lattice
{

std::vector<std::size_t> BondHistory::rows(const RowPartition &band)
{
  const auto begin = static_cast<std::ptrdiff_t>(band.rows().begin), end = static_cast<std::ptrdiff_t>(band.rows().end);
  std::vector<std::size_t> rows;
  if (begin == end)
    return rows;
  for (std::ptrdiff_t number = begin - static_cast<std::ptrdiff_t>(band.lattice().reach()); number < end; ++number)
    if (const auto row = band.lattice().row(number))
      rows.push_back(*row);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

} // namespace latcon::lattice
