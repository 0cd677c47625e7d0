#include "verification/bridge/subject.h"

#include <cmath>

#include "continuum/errors.h"
#include "continuum/isotropic_gradient.h"
#include "continuum/network_gradient.h"
#include "support/dense.h"

namespace latcon::bridge
{

bool Subject::judges_gradient(const Eigen::Matrix2d &F) const
{
  for (const continuum::FibreFamily &family : cauchy_born.families())
  {
    const double stretch = (to_continuum(F) * family.direction).norm();
    if (stretch < continuum::LatticeGradient::full_stretch && std::abs(stretch - 1.) > 1e-12) // no force at 1
      return false;
  }
  return judges(Law::lattice_gradient);
}

bool Subject::judges_network_gradient(const Eigen::Matrix2d &F) const
{
  const bool is_stretched =
    F.isIdentity(1e-12) || !(support::singular_values(F)(1) < continuum::LatticeGradient::full_stretch);
  return is_stretched && judges(Law::mooney_rivlin_network);
}

NetworkComparison::NetworkComparison(const Subject &subject, const lattice::TriangularLattice &sheet,
                                     const Eigen::Matrix2d &F)
  : network_energy(subject.network.energy(to_continuum(F))),
    network_stress(to_lattice(subject.network.first_piola_stress(to_continuum(F))))
{
  Eigen::MatrixXd energies(1, n_lattice_rotations), stresses(4, n_lattice_rotations);
  for (int k = 0; k < n_lattice_rotations; ++k)
  {
    const Eigen::Matrix2d R = lattice_rotation(k);
    const LatticeResponse response = homogeneous_response(sheet, subject.material, F * R);
    const Eigen::Matrix2d rotated_stress = response.first_piola_stress * R.transpose();
    energies(0, k) = response.energy_density;
    stresses.col(k) = rotated_stress.reshaped();
    if (k == 0)
    {
      lattice_energy = response.energy_density;
      lattice_stress = rotated_stress;
    }
  }
  energy = rotation_mean(energies);
  stress = rotation_mean(stresses);
}

Subject subject(const input::Case &input, const lattice::Material &material, const Laws &laws)
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
    // Claims report that there is no such law.
  }
  const SmallStrain theory = small_strain(sheet, material);
  const GradientLengths lengths = gradient_lengths(sheet, material);
  return {std::string("NN") + (material.next_nearest ? "+NNN" : "") + (material.third_nearest ? "+3NN" : ""),
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

Subject subject(const input::Case &input)
{
  return subject(input, input.material());
}

} // namespace latcon::bridge
