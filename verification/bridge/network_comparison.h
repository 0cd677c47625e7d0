#pragma once

#include "verification/bridge/anisotropy.h"
#include "verification/bridge/subject.h"

namespace latcon::bridge
{

/// Network law and lattice in one homogeneous deformation. The law leaves out the lattice's dependence on direction and
/// nothing else: it is the mean over rotations of the lattice, and no farther from the lattice than that dependence
/// goes (theory-comparison.md, eqs. (H.14), (H.15)). Stresses are components 11, 21, 12, 22.
class NetworkComparison
{
public:
  /// Two closed forms of one sum over some ten bonds: a few hundred round-offs of its largest term [-].
  static constexpr double equal_formulas = 1e-10;

  /// @param sheet as homogeneous_response() takes it; its simulator responds, rotated
  /// @param F of the sheet [-]
  NetworkComparison(const Subject &subject, const lattice::TriangularLattice &sheet, const Eigen::Matrix2d &F);

  double network_energy, lattice_energy;          ///< [J/m^3]
  Eigen::Matrix2d network_stress, lattice_stress; ///< first Piola [Pa]
  RotationMean energy, stress;                    ///< of the lattice

  /// Relative distances of the law from the lattice's mean [-].
  double energy_from_mean() const { return std::abs(network_energy / energy.mean(0) - 1.); }
  double stress_from_mean() const { return (network_stress.reshaped() - stress.mean).norm() / stress.mean.norm(); }

  /// Relative errors [-] of the law for the lattice as it is, and their bounds.
  double energy_error() const { return std::abs(network_energy / lattice_energy - 1.); }
  double energy_bound() const { return energy.bound / std::abs(lattice_energy) + equal_formulas; }
  double stress_error() const { return (network_stress - lattice_stress).norm() / lattice_stress.norm(); }
  double stress_bound() const { return stress.bound / lattice_stress.norm() + equal_formulas; }
};

} // namespace latcon::bridge
