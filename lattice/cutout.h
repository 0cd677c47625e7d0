#pragma once

#include <variant>

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

} // namespace latcon::lattice
