#pragma once

#include <utility>
#include <vector>

#include "lattice/state.h"

namespace latcon::lattice
{

/// Parts removed from a sheet before it is loaded, undeformed.
struct Cutout
{
  double hole_radius = 0.;  ///< R [m]: sites closer to the middle of the sheet, (length() / 2, 0), are removed; 0: none
  double notch_length = 0.; ///< of a cut along Y = 0 from the left edge [m]: sites on it and bonds across it; 0: none
};

/// Takes pieces out of a sheet that nothing has broken yet. What is left at the rim is free and undamaged: bonds that
/// were never there are not lost.
void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout);

/// Places of the sites of a seed crack in a line along x: of `n` > 0 sites of the line nearest to the start, from its
/// site nearest to the start on. Of two that are equally near, the one with the larger coordinate.
/// @param start (X, Y) of the left end [m]
/// @throws std::invalid_argument if there are fewer, or they are less than two spacings from the lower or the upper
/// edge, where sites are held
std::vector<std::size_t> seed_line(const TriangularLattice &lattice, const Eigen::Vector2d &start, std::size_t n);

/// Places of the sites of a seed crack in a closed rectangle, by increasing X, then Y.
/// @param lower,upper opposite corners (X, Y) [m]
/// @throws std::invalid_argument if there are none, or one is as near to an edge as in seed_line()
std::vector<std::size_t> seed_slit(const TriangularLattice &lattice, const Eigen::Vector2d &lower,
                                   const Eigen::Vector2d &upper);

/// Bonds whose reference line crosses the segment from (from, Y) to (to, Y) [m], or ends there: place where each starts
/// and its kind. For Simulation::cut_bonds(), as the seed crack of a nonlocal continuum.
std::vector<std::pair<std::size_t, std::size_t>> bonds_across(const TriangularLattice &lattice, double from, double to,
                                                              double Y);

} // namespace latcon::lattice
