#pragma once

#include <memory>
#include <optional>
#include <string>

#include "continuum/gradient_law.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/laws.h"
#include "verification/bridge/slowest_wave.h"
#include "verification/input/case.h"

namespace latcon::bridge
{

/// Subject of claims: a lattice and the continuum laws that should agree with it. Claims compare the two without
/// assumptions on how they were derived, so a test can combine a wrong law with a correct lattice.
struct Subject
{
  std::string name; ///< in results: shells_name()
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

  /// Returns the tolerance of a row about a law; none, which makes the row informational, if the law is not judged.
  std::optional<double> tolerance(Law law, double value) const
  {
    return laws.count(law) > 0 ? std::optional(value) : std::nullopt;
  }

  /// Returns the tolerance of a row that compares the next order in kd of the gradient continuum and the lattice at F.
  /// None, which makes the row informational, where bonds are below full_stretch: there the gradient energy omits the
  /// negative contribution of bonds in compression, to remain positive (theory-continuum.md, eq. (C.27)).
  std::optional<double> gradient_tolerance(const Eigen::Matrix2d &F, double value) const;

  /// Returns the tolerance as gradient_tolerance() for the network, which has fibres in every direction.
  std::optional<double> network_gradient_tolerance(const Eigen::Matrix2d &F, double value) const;
};

/// Creates the subject of a case with another `material`.
[[nodiscard]] Subject subject(const input::Case &input, const lattice::Material &material,
                              const Laws &laws = all_laws());

/// Creates the subject of a case with its own material; all laws are judged.
[[nodiscard]] Subject subject(const input::Case &input);

} // namespace latcon::bridge
