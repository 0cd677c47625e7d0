#pragma once

#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Claim `energy`: in homogeneous deformation the lattice and its Cauchy-Born law have the same energy density and the
/// same first Piola stress, for every F. The network law is the lattice's mean over all rotations, and differs from the
/// lattice by no more than its dependence on direction (theory-comparison.md, eq. (H.15)). At small strain both
/// isotropic laws have the lattice's moduli and wave speeds.
///
/// The lattice's stress is the force that its simulator computes on the edge of a sheet, its energy the sum over the
/// bonds of that sheet. No formula of the continuum is used.
/// @param samples number of random F, rotations times stretches between 0.7 and 3.5
output::Results energy_claim(const bridge::Subject &subject, unsigned int samples);

} // namespace latcon::claims
