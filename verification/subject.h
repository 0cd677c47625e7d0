#pragma once

#include <memory>

#include "continuum/isotropic_gradient.h"
#include "verification/case.h"
#include "verification/homogenisation.h"

namespace verification
{

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
  continuum::CauchyBorn cauchy_born;
  continuum::IsotropicNetwork network; ///< mean of cauchy_born over all rotations of the lattice
  Calibration mooney_rivlin;
  bool ratio_is_calibrated; ///< the Mooney-Rivlin ratio was fitted, not given
  GradientLengths lengths;
  std::shared_ptr<const continuum::GradientLaw> lattice_gradient;   ///< with lengths.lattice
  std::shared_ptr<const continuum::GradientLaw> isotropic_gradient; ///< with lengths.isotropic_static
};

/// The subject of a case; `material` may differ from the case's own.
inline Subject subject(const Case &input, const lattice::Material &material)
{
  const lattice::TriangularLattice sheet = input.lattice();
  Calibration calibration = calibrate_mooney_rivlin(sheet, material, input.deformation());
  if (input.continuum.mooney_rivlin_ratio)
    calibration = with_ratio(sheet, material, input.deformation(), *input.continuum.mooney_rivlin_ratio);
  const SmallStrain theory = small_strain(sheet, material);
  const GradientLengths lengths = gradient_lengths(sheet, material);
  return {material.next_nearest ? "NN+NNN" : "NN",
          input.spacing,
          input.orientation,
          material,
          input.deformation(),
          theory,
          cauchy_born(sheet, material),
          isotropic_network(sheet, material),
          calibration,
          !input.continuum.mooney_rivlin_ratio,
          lengths,
          std::make_shared<continuum::LatticeGradient>(bond_families(sheet, material), lengths.lattice),
          std::make_shared<continuum::IsotropicGradient>(theory.shear_modulus, lengths.isotropic_static)};
}

/// The subject of a case as it stands.
inline Subject subject(const Case &input)
{
  return subject(input, input.material());
}

} // namespace verification
