#pragma once

#include <array>

#include <Eigen/Core>

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

/// Free wave exp(-g t) cos(w t) of one polarisation. For g at F = I see theory-continuum.md, eq. (C.48).
struct PlaneWave
{
  double frequency;             ///< w [rad/s], >= 0; 0 if the wave is overdamped or the sheet is unstable
  double decay;                 ///< g [1/s]
  Eigen::Vector2d polarisation; ///< unit vector p [-], current frame
};

/// Polarisation of a wave.
enum class Wave
{
  longitudinal,
  shear
};

/// Returns both waves: first the wave whose polarisation is closer to `normal`, called longitudinal, then the shear
/// wave. The names are exact at F = I in directions of symmetry. All numbers are NaN if an entry of the matrices is not
/// finite.
/// @param normal direction of propagation of the wave fronts in the deformed sheet
std::array<PlaneWave, 2> plane_waves(const WaveMatrices &matrices, const Eigen::Vector2d &normal);

/// Returns the larger frequency of the two waves [rad/s].
/// @throws std::runtime_error if a wave does not oscillate, that is, its frequency is 0 or not finite
double fastest_frequency(const std::array<PlaneWave, 2> &waves);

/// Returns the unit normal of the wave fronts of K in the deformed sheet, F^-T K normalised.
Eigen::Vector2d wave_normal(const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
