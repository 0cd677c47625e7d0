#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

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
  double scatter = 0.;            ///< largest displacement of a point over the spacing of the grid [-]

  void declare(Parameters &parameters);
  /// Reports what the continuum cannot be, if it is used: a grid whose points the bonds do not join, among others.
  void check(const Case &input, Parameters &parameters) const;
  /// Returns the sheet of a case. @throws std::invalid_argument if there is none
  lattice::TriangularLattice sheet(const Case &input) const;

private:
  lattice::TriangularLattice new_sheet(const Case &input) const;
  /// The last sheet of scattered points, whose weights take long, and what it is made of.
  mutable std::shared_ptr<const std::pair<std::vector<double>, lattice::TriangularLattice>> last_;
};

} // namespace latcon::input
