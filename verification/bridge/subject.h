#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/SVD>

#include "continuum/errors.h"
#include "continuum/isotropic_gradient.h"
#include "continuum/lattice_gradient.h"
#include "continuum/network_gradient.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/laws.h"
#include "verification/bridge/slowest_wave.h"
#include "verification/input/case.h"

namespace latcon::bridge
{

/// What rows call a lattice with one shell or two: "NN" or "NN+NNN".
inline std::string shells_name(const lattice::Material &material)
{
  return material.next_nearest ? "NN+NNN" : "NN";
}

/// What a claim is about: a lattice on one side, the laws meant to agree with it on the other. The claims compare the
/// two and take nothing for granted about how they came together, so a test can put a wrong law beside a right lattice.
struct Subject
{
  std::string name; ///< in results: "NN+NNN" or "NN"
  double spacing;   ///< d [m]
  lattice::Orientation orientation;
  lattice::Material material;
  Eigen::Matrix2d deformation; ///< F of the loaded sheet [-]
  SmallStrain theory;
  SlowestWave slowest_wave; ///< about the loaded sheet
  continuum::CauchyBorn cauchy_born;
  continuum::IsotropicNetwork network;      ///< mean of cauchy_born over all rotations of the lattice
  std::optional<Calibration> mooney_rivlin; ///< none if no such law has a thickness all along the loading path
  bool ratio_is_calibrated;                 ///< the Mooney-Rivlin ratio was fitted, not given
  GradientLengths lengths;
  std::shared_ptr<const continuum::GradientLaw> lattice_gradient;   ///< with lengths.lattice
  std::shared_ptr<const continuum::GradientLaw> isotropic_gradient; ///< with lengths.isotropic_static
  std::shared_ptr<const continuum::GradientLaw> network_gradient;   ///< mean of lattice_gradient over all rotations
  Laws laws; ///< those that are judged; what is found about others is reported

  /// Whether the loaded lattice stays homogeneous. If not there are no waves about it, and no sheet to compare.
  bool is_stable() const { return slowest_wave.squared_speed > 0.; }

  /// The tolerance of a row about a law: none, so that the row is reported, if the law is not to be judged.
  std::optional<double> tolerance(Law law, double value) const
  {
    return laws.count(law) > 0 ? std::optional(value) : std::nullopt;
  }

  /// The tolerance of a row by which the gradient continuum has the lattice's next order in kd about F: none, so that
  /// the row is reported, where the gradient energy is not that of the bonds as they stand. It leaves out what bonds
  /// that push would take from it, and so stays positive (theory-continuum.md, eq. (C.27)).
  std::optional<double> gradient_tolerance(const Eigen::Matrix2d &F, double value) const
  {
    for (const continuum::FibreFamily &family : cauchy_born.families())
    {
      const double stretch = (to_continuum(F) * family.direction).norm();
      if (stretch < continuum::LatticeGradient::full_stretch && std::abs(stretch - 1.) > 1e-12) // no force at 1
        return {};
    }
    return tolerance(Law::lattice_gradient, value);
  }

  /// The same of the network, which has fibres in every direction.
  std::optional<double> network_gradient_tolerance(const Eigen::Matrix2d &F, double value) const
  {
    if (!F.isIdentity(1e-12) && F.jacobiSvd().singularValues()(1) < continuum::LatticeGradient::full_stretch)
      return {};
    return tolerance(Law::mooney_rivlin_network, value);
  }
};

/// The subject of a case; `material` may differ from the case's own.
inline Subject subject(const input::Case &input, const lattice::Material &material, const Laws &laws = all_laws())
{
  const lattice::TriangularLattice sheet = input.lattice();
  const std::optional<double> given = input.continuum.mooney_rivlin_ratio;
  std::optional<Calibration> calibration;
  try
  {
    calibration = given ? with_ratio(sheet, material, input.deformation(), *given)
                        : calibrate_mooney_rivlin(sheet, material, input.deformation());
  }
  catch (const continuum::NonPhysicalState &)
  {
    // Claims say so.
  }
  const SmallStrain theory = small_strain(sheet, material);
  const GradientLengths lengths = gradient_lengths(sheet, material);
  return {shells_name(material),
          input.spacing,
          input.orientation,
          material,
          input.deformation(),
          theory,
          slowest_wave(sheet, material, input.deformation()),
          cauchy_born(sheet, material),
          isotropic_network(sheet, material),
          calibration,
          !given,
          lengths,
          std::make_shared<continuum::LatticeGradient>(bond_families(sheet, material), lengths.lattice),
          std::make_shared<continuum::IsotropicGradient>(theory.shear_modulus, lengths.isotropic_static),
          std::make_shared<continuum::NetworkGradient>(bond_families(sheet, material), lengths.lattice),
          laws};
}

/// The subject of a case as it stands, all laws judged.
inline Subject subject(const input::Case &input)
{
  return subject(input, input.material());
}

} // namespace latcon::bridge
