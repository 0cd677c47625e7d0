#pragma once

#include <functional>
#include <vector>

#include "lattice/contact.h"
#include "verification/bridge/subject.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/rows.h"

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

/// Returns the rows on the contact of a case: two free sites that fly at each other part with the
/// coefficient of restitution of theory.md, eq. (L.13), from the constants of bonds and contact alone, and with the
/// momentum and the energy that they had, what the dashpot took included. By the integrator of the case, with its step
/// or a shorter one that resolves the contact.
/// @param input has contact
/// @param planted error that a test introduces into the contact law of the simulator
[[nodiscard]] output::Results contact_rows(
  const bridge::Subject &subject, const input::Case &input,
  const std::function<void(lattice::ContactLaw &)> &planted = [](lattice::ContactLaw &) {});

/// The part on inhomogeneous fields: the energy that a sinusoidal displacement adds to a homogeneous state, and the
/// energy of a travelling wave.
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
