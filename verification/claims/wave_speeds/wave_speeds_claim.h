#pragma once

#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"
#include "verification/claims/continuum_waves.h"
#include "verification/input/case.h"

namespace latcon::claims
{

/// Claim `wave-speeds`: plane waves about a homogeneous state run as fast on the lattice as Bloch's analysis of it
/// says, and on the finite elements as the closed form of their continuum says; the two continua differ from the
/// lattice by an error of second order in kd (local law) and fourth (with the lattice's gradient energy and
/// micro-inertia). Dashpots attenuate them on both sides as Kelvin's theory says.
///
/// Writes the tables `wave_speeds` (phase velocities) and `attenuation`. Every rank computes all of it.
struct WaveSpeedsOptions
{
  std::vector<Eigen::Matrix2d> states;              ///< homogeneous F [-]
  std::vector<Eigen::Matrix2d> damped_states;       ///< states in which attenuation is measured, if there are dashpots
  std::vector<double> kd{0.05, 0.1, 0.25, 0.5, 1.}; ///< of the waves that are run, ascending, two or more [-]
  WaveMesh mesh;                                    ///< of the finite elements
  input::Case::Integrator integrator = input::Case::Integrator::velocity_verlet; ///< of damped waves on the lattice
  /// Error that a test introduces into the lattice of the runs; none otherwise.
  std::function<lattice::Material(lattice::Material)> planted = {};
};

/// Checks the claim. Collective.
ClaimOutcome wave_speeds_claim(const bridge::Subject &subject, const WaveSpeedsOptions &options);

} // namespace latcon::claims
