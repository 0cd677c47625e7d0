/// Plane waves in sheets with Maxwell branches.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "verification/bridge/plane_waves.h"

#include "lattice/material.h"

namespace latcon::bridge
{

/// Free wave Re(p exp(s t)) of one polarisation, with s = -g + i w.
struct MemoryWave
{
  std::complex<double> rate;     ///< s [1/s], w > 0; NaN if the wave does not oscillate
  Eigen::Vector2cd polarisation; ///< p [-], current frame; its largest entry is 1; NaN as the rate

  double frequency() const { return rate.imag(); } ///< w [rad/s]
  double decay() const { return -rate.real(); }    ///< g [1/s]
};

/// Branch of a homogeneous sheet for a plane wave, per unit mass.
struct BranchMatrix
{
  Eigen::Matrix2d stiffness; ///< G_i, added to D in fast motion [1/s^2]
  double relaxation_time;    ///< tau_i [s]
};

/// Solves (s^2 + s C + D + sum_i s tau_i / (1 + s tau_i) G_i) p = 0 (theory.md, eq. (L.30); theory-viscoelastic.md, eq.
/// (V.6)) for the two waves that oscillate. The longitudinal wave comes first, as in plane_waves(). A wave that does
/// not oscillate, because it is overdamped or the sheet is unstable, is NaN.
/// @param relaxed C and D, without branches
/// @param normal as for plane_waves()
/// @throws std::runtime_error if an entry of the matrices is not finite
std::array<MemoryWave, 2> memory_waves(const WaveMatrices &relaxed, const std::vector<BranchMatrix> &branches,
                                       const Eigen::Vector2d &normal);

/// Solves the same for the generalised complex modulus of the lattice's own Bloch matrices, dispersion included.
/// @param lattice only its bonds matter
/// @param F homogeneous deformation, whose bonds are relaxed
/// @param K referential wave vector [1/m], not 0
/// @throws std::runtime_error if an entry of the matrices is not finite
/// @throws std::invalid_argument for bonds with a CustomMemory
std::array<MemoryWave, 2> memory_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                       const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Stiffness that the branches add to the Bloch matrix D in fast motion, sum_i G_i [1/s^2].
/// @throws std::invalid_argument for bonds with a CustomMemory
Eigen::Matrix2d glassy_stiffness(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                 const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
