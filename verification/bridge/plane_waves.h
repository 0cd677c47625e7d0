#pragma once

#include <array>

#include <Eigen/Core>

namespace latcon::bridge
{

/// What a plane wave u = p exp(i K.X) meets in a homogeneous sheet, per unit of the mass that moves with it, so that
///   u'' + C u' + D u = 0.
/// K [1/m] is referential: waves are labelled by the undeformed sheet.
struct WaveMatrices
{
  Eigen::Matrix2d stiffness; ///< D [1/s^2], symmetric
  Eigen::Matrix2d damping;   ///< C [1/s], symmetric
};

/// A free wave exp(-g t) cos(w t) of one polarisation. At F = I theory-continuum.md, eq. (C.48), has g.
struct PlaneWave
{
  double frequency;             ///< w [rad/s], >= 0; 0 if the wave is overdamped or the sheet is not stable
  double decay;                 ///< g [1/s]
  Eigen::Vector2d polarisation; ///< unit vector p [-], current frame
};

/// The two polarisations.
enum class Wave
{
  longitudinal,
  shear
};

/// Both waves: first the one whose polarisation is closer to `normal`, the longitudinal one, then the shear wave. Names
/// that fit exactly at F = I in directions of symmetry. All numbers of both are not-a-number if an entry of the
/// matrices is not finite.
/// @param normal direction in which the wave fronts travel in the deformed sheet
std::array<PlaneWave, 2> plane_waves(const WaveMatrices &matrices, const Eigen::Vector2d &normal);

/// Larger frequency of the two waves [rad/s].
/// @throws std::runtime_error if one of them does not oscillate: its frequency is 0 or not finite
double fastest_frequency(const std::array<PlaneWave, 2> &waves);

/// Direction of the wave fronts of K in the deformed sheet, F^-T K normalised.
Eigen::Vector2d wave_normal(const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
