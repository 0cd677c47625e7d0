#pragma once

#include <functional>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/rows.h"
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
  std::function<lattice::Material(lattice::Material)> planted = [](lattice::Material material) { return material; };
};

/// Checks the claim. Collective.
ClaimOutcome wave_speeds_claim(const bridge::Subject &subject, const WaveSpeedsOptions &options);

/// Returns the rows of the claim `wave-speeds` on absorbing ends: of long waves an end reflects the share (Z - Z_end) /
/// (Z + Z_end) of the displacement, which is 0 where its impedance is that of the loaded sheet (theory.md, eq. (L.16)).
/// A pulse in the loaded sheet meets the right end; the integral of its displacement before and after is the share of
/// waves of infinite length, so that reflections of first order in k d, which the end has, drop out.
[[nodiscard]] output::Results absorbing_end_rows(const bridge::Subject &subject);

/// Rows of the claim `wave-speeds` on the network law with its gradient energy about the homogeneous state F.
///
/// The dynamical matrix of the lattice, (W.1) of theory-comparison.md, depends on the orientation of the lattice in the
/// undeformed sheet. The network is the mean over all rotations: its matrix agrees with the mean of the lattice's to
/// second order of kd without gradient energy, and to fourth with it; and it is off the lattice as it stands by no more
/// than the lattice's dependence on direction, whose bound is (H.15). Only Bloch sums over bonds represent
/// the lattice. Every rank computes all of it.
/// @param mesh of the finite elements, which have to have the frequencies of their continuum
void network_waves(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveMesh &mesh,
                   ClaimOutcome &outcome);

} // namespace latcon::claims
