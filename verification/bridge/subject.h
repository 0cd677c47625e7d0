#pragma once

#include <memory>
#include <optional>
#include <string>

#include "continuum/gradient_law.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/laws.h"
#include "verification/bridge/plane_waves.h"
#include "verification/input/case.h"

namespace latcon::bridge
{

/// Subject of claims: a lattice and the continuum laws that should agree with it. Claims compare the two without
/// assumptions on how they were derived, so a test can combine a wrong law with a correct lattice.
struct Subject
{
  std::string name; ///< in results: "NN", then "+NNN" with next-nearest neighbours and "+3NN" with third-nearest ones
  double spacing;   ///< d [m]
  lattice::Orientation orientation;
  lattice::Material material;
  Eigen::Matrix2d deformation; ///< F of the loaded sheet [-]
  SmallStrain theory;
  SlowestWave slowest_wave; ///< about the loaded sheet
  continuum::CauchyBorn cauchy_born;
  continuum::IsotropicNetwork network;      ///< mean of cauchy_born over all rotations of the lattice
  std::optional<Calibration> mooney_rivlin; ///< none if no such law has an equilibrium thickness along the loading path
  bool ratio_is_calibrated;                 ///< true if the Mooney-Rivlin ratio was fitted, false if given
  GradientLengths lengths;
  std::shared_ptr<const continuum::GradientLaw> lattice_gradient;   ///< with lengths.lattice
  std::shared_ptr<const continuum::GradientLaw> isotropic_gradient; ///< with lengths.isotropic_static
  std::shared_ptr<const continuum::GradientLaw> network_gradient;   ///< mean of lattice_gradient over all rotations
  Laws laws; ///< laws to judge; results for other laws are only reported

  /// Returns true if the homogeneous loaded lattice is stable. Otherwise it has no waves, and there is no sheet to
  /// compare.
  bool is_stable() const { return slowest_wave.squared_speed > 0.; }

  /// Returns whether rows about a law are judged; otherwise they are reported.
  bool judges(Law law) const { return laws.count(law) > 0; }

  /// Returns whether a row is judged that compares the next order in kd of the gradient continuum and the lattice at F:
  /// not where bonds are below full_stretch. There the gradient energy omits the negative contribution of bonds in
  /// compression, to remain positive (theory-continuum.md, eq. (C.27)).
  bool judges_gradient(const Eigen::Matrix2d &F) const;

  /// Returns the same for the network, which has fibres in every direction.
  bool judges_network_gradient(const Eigen::Matrix2d &F) const;

  /// Returns a sheet of the lattice, for its bonds and periods. @param extent in spacings
  lattice::TriangularLattice sheet(double extent = 10.) const
  {
    return {spacing, extent * spacing, extent * spacing, orientation};
  }
};

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

  /// Relative errors [-] of the law for the lattice in its own orientation.
  double energy_error() const { return std::abs(network_energy / lattice_energy - 1.); }
  double stress_error() const { return (network_stress - lattice_stress).norm() / lattice_stress.norm(); }
};

/// Creates the subject of a case with another `material`.
[[nodiscard]] Subject subject(const input::Case &input, const lattice::Material &material,
                              const Laws &laws = all_laws());

/// Creates the subject of a case with its own material; all laws are judged.
[[nodiscard]] Subject subject(const input::Case &input);

} // namespace latcon::bridge
