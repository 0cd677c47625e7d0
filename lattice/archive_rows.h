#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/row_partition.h"

namespace latcon::lattice
{

/// Refuses what an archive holds, before it is used. @throws std::invalid_argument unless it `holds`
inline void require_archived(bool holds, const std::string &problem)
{
  if (!holds)
    throw std::invalid_argument(problem);
}

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
      for (std::size_t row = 0; row < lattice.rows(); ++row)
        values.insert(values.end(), &field[lattice.index(row, 0)],
                      &field[lattice.index(row, 0)] + lattice.sites_in_row(row));
  }
  archive(name, values);
  if constexpr (Archive::loads)
  {
    require_archived(values.size() == lattice.n_sites(), "`" + name + "` is of a sheet of another size");
    for (const std::size_t row : rows)
    {
      const std::size_t place = lattice.index(row, 0);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(lattice.site_number(place)), lattice.sites_in_row(row),
                  &field[place]);
    }
  }
}

} // namespace latcon::lattice
