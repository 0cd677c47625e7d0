#pragma once

#include "lattice/state.h"

namespace latcon::lattice
{

/// Result of a relaxation.
struct Relaxation
{
  std::size_t iterations;
  double residual; ///< largest force on a free site, per sheet thickness [N/m]
};

/// Moves the free sites to static equilibrium, all bonds kept and without dashpots, by the FIRE minimiser (Bitzek et
/// al., Phys. Rev. Lett. 97, 170201 (2006)). Velocities end at zero.
/// @param tolerance stops once no free site feels a force larger than this [N/m]
/// @throws std::runtime_error if that takes more than `max_iterations`, or a position ceases to be finite; the text has
/// the last residual
Relaxation relax(State &state, const TriangularLattice &lattice, const Material &material, double tolerance,
                 std::size_t max_iterations = 200000);

} // namespace latcon::lattice
