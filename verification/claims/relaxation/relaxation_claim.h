#pragma once

#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"
#include "verification/claims/spectrum.h"

namespace latcon::claims
{

/// Size of the claim.
struct RelaxationOptions
{
  /// Time steps of each integrator of the lattice; fewer if three of the longest relaxation times pass before.
  std::size_t max_steps = 2000;
  PlantedBranches planted = [](const lattice::Material &material) { return material; }; ///< for tests
};

/// Claim `relaxation`: a sheet that is strained suddenly and then held relaxes along the closed form of its branches
/// (theory.md, eq. (L.31)), with both time integrators: first Piola stress, measured as the force on the edge of the
/// sheet; energy stored in each branch, energy dissipated by each, and the energy balance. Finite elements of the
/// Cauchy-Born continuum relax along the same closed form.
///
/// Without branches of its own, a lattice is given three per shell.
ClaimOutcome relaxation_claim(const bridge::Subject &subject, const RelaxationOptions &options);

} // namespace latcon::claims
