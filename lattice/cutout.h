#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "lattice/state.h"

namespace latcon::lattice
{

/// Sites closer to the middle of the sheet, (length() / 2, 0), than this are removed.
struct RoundHole
{
  double radius; ///< R [m], >= 0, undeformed
};

/// A cut along Y = 0 from the left edge: the sites on it and the bonds that cross it are removed.
struct Notch
{
  double length; ///< [m], >= 0, undeformed
};

/// Part removed from a sheet before it is loaded.
using Cutout = std::variant<RoundHole, Notch>;

/// Takes a piece out of a sheet that nothing has broken yet. What is left at the rim is free and undamaged: bonds that
/// were never there are not lost.
void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout);

/// `n` sites in a line along x: the line nearest to Y = offset, from its site nearest to X = position on. Of two that
/// are equally near, the one with the larger coordinate.
struct SeedLine
{
  double position; ///< X of the left end [m]
  double offset;   ///< Y [m]
  std::size_t n;   ///< > 0
};

/// All sites in the closed rectangle from X = position to position + length, Y = offset - height / 2 to
/// offset + height / 2.
struct SeedSlit
{
  double position; ///< X of the left end [m]
  double offset;   ///< Y of the centre line [m]
  double length;   ///< [m], >= 0
  double height;   ///< [m], >= 0
};

/// Shape of a seed crack.
using Seed = std::variant<SeedLine, SeedSlit>;

/// Places of the sites that a seed crack removes from a sheet, by increasing X, then Y.
/// @throws std::invalid_argument if there are none, or fewer than wanted, or one is less than two spacings from the
/// lower or the upper edge, where sites are held
std::vector<std::size_t> seed_sites(const TriangularLattice &lattice, const Seed &seed);

/// Bonds whose reference line crosses the segment from (from, Y) to (to, Y) [m], or ends there: place where each starts
/// and its kind. For Simulation::cut_bonds(), as the seed crack of a nonlocal continuum.
std::vector<std::pair<std::size_t, std::size_t>> bonds_across(const TriangularLattice &lattice, double from, double to,
                                                              double Y);

} // namespace latcon::lattice
