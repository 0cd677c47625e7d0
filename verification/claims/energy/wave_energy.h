#pragma once

#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"
#include "verification/claims/continuum_waves.h"

namespace latcon::claims
{

/// The part of the claim `energy` on inhomogeneous fields: the energy that a sinusoidal displacement adds to a
/// homogeneous state, and the energy of a travelling wave.
///
/// For one displacement field the lattice and the local continuum differ in second order of kd. So do the lattice and
/// the gradient continuum, with the opposite sign, since the continuum's equations are the lattice's times 1 +
/// l_d^2 k^2, and its energies are too (theory-comparison.md, eqs. (W.4), (W.5)). Divided by that, they agree to fourth
/// order.
///
/// Writes the tables `sinusoidal_energy` and `travelling_waves`. Every rank computes all of it.
struct WaveEnergyOptions
{
  std::vector<Eigen::Matrix2d> states;        ///< homogeneous F [-]
  std::vector<double> kd{0.1, 0.25, 0.5, 1.}; ///< of the fields [-]; travelling waves are judged at 0.25
  WaveMesh mesh;                              ///< of the finite elements
  /// Mesh of travelling waves. The nodal values of a wave leave a little energy to the other modes of the mesh,
  /// whose kinetic energy is all micro-inertia: of 6 cells a few 1e-4 of the micro-inertia of a wave that is ten times
  /// slower than the other one, of 10 cells 1e-5.
  WaveMesh travelling_mesh{10};
};

/// Checks this part of the claim. Collective.
ClaimOutcome wave_energy_claim(const bridge::Subject &subject, const WaveEnergyOptions &options);

} // namespace latcon::claims
