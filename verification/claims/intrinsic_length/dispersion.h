#pragma once

#include <array>

#include "verification/claims/continuum_waves.h"
#include "verification/claims/lattice_waves.h"

namespace latcon::claims
{

/// alpha [-] of w^2 = c^2 k^2 (1 - alpha d^2 k^2 + ...), of the longitudinal and the shear wave: softening of
/// short waves; negative: hardening.
using Alpha = std::array<double, 2>;

/// Alpha of a lattice at the homogeneous state F, in closed form (theory-comparison.md, eq. (W.2), with A_2 and A_4 of
/// theory-continuum.md, eq. (C.47)).
/// @param N referential direction of the wave, a unit vector
/// @param nearest_part if given, receives the contribution of the nearest-neighbour bonds
Alpha lattice_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                    const Eigen::Matrix2d &F, const Eigen::Vector2d &N, Alpha *nearest_part = nullptr);

/// Alpha of a lattice from its exact dispersion at kd = 0.02 and 0.04, extrapolated to 0; error 1e-7.
Alpha bloch_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Matrix2d &F, const Eigen::Vector2d &N);

/// Alpha of a moving lattice: runs four waves of one direction, kd from 0.2 to 0.8, and fits w^2/k^2 by a cubic in k^2.
/// The error of the fit is 3e-6. @throws std::runtime_error if a wave does not oscillate
Alpha running_alpha(double spacing, lattice::Orientation orientation, const WaveDirection &direction,
                    const lattice::Material &material, const Eigen::Matrix2d &F);

/// Alpha of a continuum, in closed form. @param spacing d [m], the unit of length of alpha
Alpha continuum_alpha(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &N, double spacing);

} // namespace latcon::claims
