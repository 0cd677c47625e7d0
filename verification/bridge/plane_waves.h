/// Plane waves in homogeneous sheets: of given matrices, and of the lattice.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "lattice/material.h"

namespace latcon::bridge
{

/// Stiffness and damping of a homogeneous sheet for a plane wave u = p exp(i K.X), per unit mass, so that
///   u'' + C u' + D u = 0.
/// The wave vector K [1/m] is referential.
struct WaveMatrices
{
  Eigen::Matrix2d stiffness; ///< D [1/s^2], symmetric
  Eigen::Matrix2d damping;   ///< C [1/s], symmetric
};

/// Free wave exp(-g t) cos(w t) of one polarisation. For g at F = I see theory-continuum.md, eq. (C.62).
struct PlaneWave
{
  double frequency;             ///< w [rad/s], >= 0; 0 if the wave is overdamped or the sheet is unstable
  double decay;                 ///< g [1/s]
  Eigen::Vector2d polarisation; ///< unit vector p [-], current frame
};

/// Returns both waves: first the wave whose polarisation is closer to `longitudinal` [-, current frame], then the shear
/// wave. All numbers are NaN if an entry of the matrices is not finite.
std::array<PlaneWave, 2> plane_waves(const WaveMatrices &matrices, const Eigen::Vector2d &longitudinal);

/// Returns the larger frequency of the two waves [rad/s].
/// @throws std::runtime_error if a wave does not oscillate, that is, its frequency is 0 or not finite
double fastest_frequency(const std::array<PlaneWave, 2> &waves);

/// Returns the unit normal of the wave fronts of K in the deformed sheet, F^-T K normalised.
Eigen::Vector2d wave_normal(const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Returns both waves at K [1/m, referential] of the matrices(K) about the state F. The longitudinal wave is the one
/// closer to the polarisation at 1e-3 K that is closer to the wave normal: it keeps this name where polarisations turn
/// with K, by up to 45 degrees. The names are exact at F = I in directions of symmetry.
template <class Matrices>
std::array<PlaneWave, 2> named_waves(const Matrices &matrices, const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  const WaveMatrices of_long{matrices(Eigen::Vector2d(1e-3 * K)).stiffness, Eigen::Matrix2d::Zero()};
  return plane_waves(matrices(K), plane_waves(of_long, wave_normal(F, K))[0].polarisation);
}

/// Returns the dynamical matrices of an infinite lattice at the homogeneous deformation F, divided by the mass of a
/// site (theory-comparison.md, eq. (W.1)); exact for all wavelengths.
/// @param K referential wave vector [1/m]
WaveMatrices bloch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                            const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Returns both waves of the lattice at K, without dashpots.
std::array<PlaneWave, 2> bloch_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Slowest, or unstable, wave of an infinite lattice.
struct SlowestWave
{
  double squared_speed; ///< smallest w^2 / k^2 [m^2/s^2] of all waves; the lattice is unstable unless positive; NaN
                        ///< if any value is NaN
  Eigen::Vector2d wave_vector; ///< referential K of that wave [1/m]
};

/// Finds the slowest of all waves about the homogeneous deformation F, without dashpots: smallest eigenvalue of the
/// Bloch matrix (theory-comparison.md, eq. (W.1)) over k^2. A descent starts at each minimum of a polar grid of wave
/// vectors, 1.5 degrees by 0.07/d, that covers the Brillouin zone. A sheet in which it is not positive buckles: its
/// homogeneous equilibrium is unstable. @param F det F > 0
SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F);

// Waves in sheets with Maxwell branches.

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
/// (V.6)) for the two waves that oscillate. The longitudinal wave comes first. A wave that does not
/// oscillate, because it is overdamped or the sheet is unstable, is NaN.
/// @param relaxed C and D, without branches
/// @param normal of the wave fronts in the deformed sheet: the polarisation closer to it is called longitudinal
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

/// Returns G_i [1/s^2] and tau_i [s] of the branches of the lattice's bonds, shell by shell, for the same F [-] and K
/// [1/m]. @throws std::invalid_argument for bonds with a CustomMemory
std::vector<BranchMatrix> branch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                          const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
