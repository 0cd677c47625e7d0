#pragma once

#include "verification/claims/nonlocal/nonlocal_claim.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Returns the half-bonds of rings on a grid, with the faults that tests plant.
std::vector<lattice::HalfBond> planted_bonds(const bridge::Subject &subject, const lattice::Grid &grid,
                                             const NonlocalOptions &options, double half_width = M_PI / 6.);

/// Rows of the claim `nonlocal` on the orders in 1/m with which rings in all directions converge to the network and to
/// the lattice's mean over rotations.
void ring_convergence(const bridge::Subject &subject, const NonlocalOptions &options, const Rows &rows);

} // namespace latcon::claims
