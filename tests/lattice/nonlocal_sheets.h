#pragma once

#include "sheets.h"

/// Sheets with the rings of the lattice's shells.
namespace nonlocal_sheets
{

/// @param m spacing of the lattice over that of the grid @param length,height in spacings of the lattice
/// @param half_width of the arcs about the lattice's directions [degrees] @param scatter of the points, see Scatter
inline latcon::lattice::TriangularLattice
sheet(latcon::lattice::Grid::Kind kind, double m, double length, double height, double half_width = 30.,
      latcon::lattice::Orientation orientation = latcon::lattice::Orientation::rows_along_crack, double scatter = 0.)
{
  using namespace latcon::lattice;
  const double d = sheets::spacing;
  const Grid grid{kind, d / m, orientation, {scatter, 5}};
  const std::vector<Ring> rings = lattice_rings(d, orientation, half_width * M_PI / 180.);
  return {grid, ring_stencil(grid, rings), d, length * d, height * d};
}

} // namespace nonlocal_sheets
