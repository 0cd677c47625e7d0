#pragma once

#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"
#include "verification/claims/spectrum.h"

namespace latcon::claims
{

/// Size of the claim.
struct ViscoelasticWavesOptions
{
  std::vector<Eigen::Matrix2d> states; ///< F about which waves are evaluated
  /// w tau of the swept branch, w being the frequency without it [rad/s]; increasing; three or more show the peak.
  std::vector<double> frequencies{0.1, 0.3, 0.6, 1., 1.7, 3., 10.};
  /// Frequencies of the finite elements, as above; three or more show the peak; none: no finite elements.
  std::vector<double> element_frequencies{1.};
  std::size_t element_states = 1; ///< number of states, from the first, with finite elements
  PlantedBranches planted = [](const lattice::Material &material) { return material; }; ///< for tests
};

/// Claim `viscoelastic-waves`: free waves in lattices whose bonds have Maxwell branches have the frequency and the
/// decay of the lattice's complex modulus, s^2 p = -M(s) p (theory.md, eq. (L.30)), dispersion included.
///
/// - With one branch per bond and no dashpots, relaxation times over two decades: |s| lies between the rubbery and the
///   glassy limit, and the decay peaks at w tau ~ 1.
/// - With the branches and the dashpots of the material, if it has any branches: a wave that is damped by less than
///   critical damping, and one twice as long.
/// - The same waves, but for the last, in the gradient continuum: runs of finite elements against its complex modulus
///   (theory-viscoelastic.md, eq. (V.6)), with their energy balance; with three relaxation times or more their peak.
/// - The branches of both continua in all directions against the lattice's: the order in kd of their errors.
///
/// Each run starts with one wave alone, the overstresses included, so that displacements are one damped oscillation.
ClaimOutcome viscoelastic_waves_claim(const bridge::Subject &subject, const ViscoelasticWavesOptions &options);

} // namespace latcon::claims
