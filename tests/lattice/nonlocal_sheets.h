#pragma once

#include "sheets.h"

/// Sheets with the rings of the lattice's shells.
namespace nonlocal_sheets
{

/// @param m spacing of the lattice over that of the grid @param length,height in spacings of the lattice
/// @param half_width of the arcs about the lattice's directions [degrees]
inline latcon::lattice::TriangularLattice
sheet(latcon::lattice::Grid::Kind kind, double m, double length, double height, double half_width = 30.,
      latcon::lattice::Orientation orientation = latcon::lattice::Orientation::rows_along_crack)
{
  using namespace latcon::lattice;
  const double d = sheets::spacing;
  const Grid grid{kind, d / m, 0., orientation};
  return {grid, ring_stencil(grid, lattice_rings(d, orientation, half_width * M_PI / 180.)), d, length * d, height * d};
}

} // namespace nonlocal_sheets
