#pragma once

#include <array>
#include <optional>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Claim `intrinsic-length`: effects of the length of the bonds, in dynamics and in statics.
///
/// Dynamics: waves soften as they shorten, by alpha (theory-comparison.md, eq. (W.2)), in every direction, with nearest
/// neighbours alone as well; the gradient continuum has the same alpha and is stable for its l_d. Statics: a free edge
/// has a layer of alternating row spacings with next-nearest neighbours, and none without.
///
/// Writes the tables `dispersion`, `dispersion_runs` and `edge_layer`. Every rank computes all of it. Collective.
/// @param angle_step [degrees] between directions in which alpha is evaluated
ClaimOutcome intrinsic_length_claim(const bridge::Subject &subject, double angle_step);

/// alpha [-] of w^2 = c^2 k^2 (1 - alpha d^2 k^2 + ...), of the longitudinal and the shear wave: softening of
/// short waves; negative: hardening.
using Alpha = std::array<double, 2>;

/// Alpha of a lattice at the homogeneous state F, in closed form (theory-comparison.md, eq. (W.2), with A_2 and A_4 of
/// theory-continuum.md, eq. (C.47)).
/// @param N referential direction of the wave, a unit vector
/// @param nearest_part if given, receives the contribution of the nearest-neighbour bonds
Alpha lattice_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                    const Eigen::Matrix2d &F, const Eigen::Vector2d &N, Alpha *nearest_part = nullptr);

/// Alpha of a lattice from its exact dispersion at kd = 0.02, 0.04 and 0.08, extrapolated to 0; error 1e-7.
Alpha bloch_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Matrix2d &F, const Eigen::Vector2d &N);

/// Alpha of a moving lattice: runs four waves of one direction, kd from 0.2 to 0.8, and fits w^2/k^2 by a cubic in k^2.
/// The error of the fit is 3e-6. @throws std::runtime_error if a wave does not oscillate
Alpha running_alpha(double spacing, lattice::Orientation orientation, const WaveDirection &direction,
                    const lattice::Material &material, const Eigen::Matrix2d &F);

/// Alpha of a continuum, in closed form. @param spacing d [m], the unit of length of alpha
Alpha continuum_alpha(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &N, double spacing);

/// Spacings of the rows of a sheet that ends in a free row, stretched along its rows and free across them.
struct EdgeLayer
{
  double stretch_across;          ///< of the bulk [-]
  std::vector<double> deviations; ///< of the spacing of rows j and j + 1 from the bulk's, over it, from the edge [-]
  double residual;                ///< largest force left on a site [N/m]
};

/// Relaxes a strip, periodic along its rows, and measures its upper edge.
/// @param stretch along the rows [-]
/// @param rows number of row spacings to measure; the strip has four times as many rows
/// @throws std::runtime_error if the lattice does not relax
EdgeLayer relaxed_edge(double spacing, const lattice::Material &material, double stretch, std::size_t rows);

/// Factor from one row spacing to the next by which a small deviation decays, from the linearised equilibrium of rows
/// (theory-comparison.md, eq. (W.6)): negative, the spacings alternate; 0 where nearest neighbours are alone.
/// @param stretch,stretch_across of the bulk [-]
double edge_decay(double spacing, const lattice::Material &material, double stretch, double stretch_across);

/// Smallest eigenvalue of the gradient energy at F over all gradients G_iJK of unit size, |G| = 1, symmetric in J and K
/// [Pa m^2]. The energy is positive if it is not negative.
double smallest_eigenvalue(const continuum::GradientLaw &law, const Eigen::Matrix2d &F);

/// Smallest eigenvalue of the lattice's gradient energy with another length, from sums over its bonds
/// (theory-continuum.md, eq. (C.22)). @param length l_d [m]
double smallest_lattice_eigenvalue(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                   const Eigen::Matrix2d &F, double length);

/// Length l_d [m] below which the lattice's gradient energy at F is no longer positive, exactly: largest eigenvalue of
/// the generalised problem of its two parts. None if bonds in compression leave no length with a positive energy;
/// not-a-number if the bonds have no finite stiffness.
std::optional<double> critical_length(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                      const Eigen::Matrix2d &F);

} // namespace latcon::claims
