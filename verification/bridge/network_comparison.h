#pragma once

#include "verification/bridge/anisotropy.h"
#include "verification/bridge/subject.h"

namespace latcon::bridge
{

/// Comparison of network law and lattice in one homogeneous deformation. The law equals the mean over rotations of the
/// lattice, so it differs from the lattice by at most the anisotropy of the lattice (theory-comparison.md, eqs. (H.14),
/// (H.15)). Stress components are in the order 11, 21, 12, 22.
class NetworkComparison
{
public:
  /// Tolerance for two closed forms of the same sum over about ten bonds: several hundred rounding errors of the
  /// largest term [-].
  static constexpr double equal_formulas = 1e-10;

  /// Evaluates law and lattice. @param sheet see homogeneous_response(); the simulator evaluates it in all rotations
  /// @param F deformation gradient of the sheet [-]
  NetworkComparison(const Subject &subject, const lattice::TriangularLattice &sheet, const Eigen::Matrix2d &F);

  double network_energy, lattice_energy;          ///< [J/m^3]
  Eigen::Matrix2d network_stress, lattice_stress; ///< first Piola [Pa]
  RotationMean energy, stress;                    ///< of the lattice

  /// Relative distances of the law from the mean of the lattice [-].
  double energy_from_mean() const { return std::abs(network_energy / energy.mean(0) - 1.); }
  double stress_from_mean() const { return (network_stress.reshaped() - stress.mean).norm() / stress.mean.norm(); }

  /// Relative errors [-] of the law for the lattice in its own orientation, and their bounds.
  double energy_error() const { return std::abs(network_energy / lattice_energy - 1.); }
  double energy_bound() const { return energy.bound / std::abs(lattice_energy) + equal_formulas; }
  double stress_error() const { return (network_stress - lattice_stress).norm() / lattice_stress.norm(); }
  double stress_bound() const { return stress.bound / lattice_stress.norm() + equal_formulas; }
};

} // namespace latcon::bridge
