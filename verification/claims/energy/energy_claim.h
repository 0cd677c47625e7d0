#pragma once

#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Claim `energy`: in homogeneous deformation the lattice and its Cauchy-Born law hold the same energy density and the
/// same first Piola stress, whatever F. The network law is the lattice's mean over all rotations, and differs from the
/// lattice by no more than its dependence on direction (theory-comparison.md, eq. (H.15)). At small strain both
/// isotropic laws have the lattice's moduli and wave speeds.
///
/// The lattice's stress is the force that its simulator finds on the edge of a sheet, its energy the sum over the bonds
/// of that sheet: nothing of the continuum's formulas is used.
/// @param samples number of random F, rotations times stretches between 0.7 and 3.5
output::Results energy_claim(const bridge::Subject &subject, unsigned int samples);

} // namespace latcon::claims
