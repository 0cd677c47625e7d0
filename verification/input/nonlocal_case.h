#pragma once

#include <cmath>

#include "lattice/triangular_lattice.h"

namespace latcon::input
{

struct Case;
class Parameters;

/// Entries of a case for the nonlocal continuum, whose bonds have the lengths of the lattice's shells.
struct NonlocalCase
{
  /// Whether the sheet of the case is the continuum. Not an entry: one case describes both sides.
  bool is_used = false;

  lattice::Grid::Kind grid = lattice::Grid::Kind::square;
  double refinement = 2.;         ///< m [-]: spacing of the lattice over that of the grid
  double half_width = M_PI / 6.;  ///< of the arcs about the lattice's six directions [rad]

  void declare(Parameters &parameters);
  /// Reports what the continuum cannot be, if it is used: a grid whose points the bonds do not join, among others.
  void check(const Case &input, Parameters &parameters) const;
  /// Returns the sheet of a case. @throws std::invalid_argument if there is none
  lattice::TriangularLattice sheet(const Case &input) const;
};

} // namespace latcon::input
