#pragma once

#include "lattice/state.h"

namespace latcon::lattice
{

/// Moves the free sites to static equilibrium, all bonds kept and without dashpots, by the FIRE minimiser (Bitzek et
/// al., Phys. Rev. Lett. 97, 170201 (2006)). Velocities end at zero.
/// @param tolerance stops once no free site feels a force larger than this [N/m]
/// @return largest force on a free site [N/m]
/// @throws std::invalid_argument for sites on rollers; std::runtime_error if that takes more than `max_iterations`, or
/// a position ceases to be finite; the text has the last residual
double relax(State &state, const TriangularLattice &lattice, const Material &material, double tolerance,
             std::size_t max_iterations = 200000);

} // namespace latcon::lattice
