#include "verification/energy/energy_claim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "lattice/forces.h"
#include "lattice/site_fields.h"
#include "verification/anisotropy.h"

namespace verification
{
namespace
{

// Sums over some ten bonds of terms that the subtraction of constants in psi makes larger than the sum: a few hundred
// round-offs of the largest term. The smallest W here is some 1e-2 of the moduli.
constexpr double equal_formulas = 1e-10;

// Fourth-order differences of the stress at +-h and +-2h, exact but for h^4 times higher moduli and round-off over h.
constexpr double strain_step = 1e-3;
constexpr double small_strain_tolerance = 1e-9;

// Lattice of 12 by 12 sites: the two outer rows and columns lack neighbours, the middle ones do not.
lattice::TriangularLattice small_sheet(const Subject &subject)
{
  return {subject.spacing, 12. * subject.spacing, 12. * subject.spacing, subject.orientation};
}

// Larger of two errors, NaN if either is NaN, which std::max would drop.
double larger(double a, double b)
{
  return std::isnan(a) || a > b ? a : b;
}

double unit_uniform(std::mt19937_64 &generator)
{
  return static_cast<double>(generator() >> 11) * 0x1p-53; // the same on every machine, unlike std's distributions
}

Eigen::Matrix2d random_deformation(std::mt19937_64 &generator)
{
  const auto rotation = [&] { return Eigen::Rotation2Dd(2. * M_PI * unit_uniform(generator)).toRotationMatrix(); };
  const auto stretch = [&] { return 0.7 + 2.8 * unit_uniform(generator); };
  const Eigen::Matrix2d outer = rotation(), inner = rotation();
  const double first = stretch(), second = stretch();
  return outer * Eigen::Vector2d(first, second).asDiagonal() * inner;
}

// dP_iJ / dF_kL at F = I for one (k, L).
template <class Stress>
Eigen::Matrix2d stress_derivative(const Stress &stress, int k, int L)
{
  const auto at = [&](double amount)
  {
    Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
    F(k, L) += amount;
    return Eigen::Matrix2d(stress(F));
  };
  const double h = strain_step;
  return (8. * (at(h) - at(-h)) - (at(2. * h) - at(-2. * h))) / (12. * h);
}

// Network law and lattice in one deformation. Means and bounds are those over all rotations of the lattice, whose
// stresses are components 11, 21, 12, 22.
struct NetworkComparison
{
  NetworkComparison(const Subject &subject, const lattice::TriangularLattice &sheet, const Eigen::Matrix2d &F)
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

  double energy_from_mean() const { return std::abs(network_energy / energy.mean(0) - 1.); }
  double stress_from_mean() const { return (network_stress.reshaped() - stress.mean).norm() / stress.mean.norm(); }

  // Errors [-] of the network law for the lattice as it is, and their bounds.
  double energy_error() const { return std::abs(network_energy / lattice_energy - 1.); }
  double energy_bound() const { return energy.bound / std::abs(lattice_energy) + equal_formulas; }
  double stress_error() const { return (network_stress - lattice_stress).norm() / lattice_stress.norm(); }
  double stress_bound() const { return stress.bound / lattice_stress.norm() + equal_formulas; }

  double network_energy, lattice_energy;          // [J/m^3]
  Eigen::Matrix2d network_stress, lattice_stress; // [Pa]
  RotationMean energy, stress;
};

} // namespace

LatticeResponse homogeneous_response(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                     const Eigen::Matrix2d &F)
{
  const lattice::State state =
    lattice::homogeneous_state(sheet, material, F, lattice::Edges::free, std::numeric_limits<double>::infinity());
  lattice::Forces forces(sheet, material);
  forces.evaluate(state, state.vx, state.vy);
  const auto force = [&](std::size_t row, std::size_t column)
  {
    const std::size_t place = sheet.index(row, column);
    return Eigen::Vector2d(forces.fx()[place], forces.fy()[place]);
  };

  // The two uppermost rows hold the rest of the sheet: P times their normal, over the length d of one column; likewise
  // the left end, whose sites with missing neighbours repeat every two rows.
  const std::size_t top = sheet.rows() - 1, column = sheet.columns() / 2, row = 2 * (sheet.rows() / 4);
  const double d = sheet.spacing();
  const Eigen::Vector2d across = -(force(top, column) + force(top - 1, column)) / d;
  const Eigen::Vector2d along = (force(row, 0) + force(row, 1) + force(row + 1, 0)) / (std::sqrt(3.) * d);

  const bool rows_along_x = sheet.orientation() == lattice::Orientation::rows_along_crack;
  Eigen::Matrix2d P;
  P.col(rows_along_x ? 0 : 1) = along;
  P.col(rows_along_x ? 1 : 0) = across;
  const lattice::SiteFields fields = lattice::site_fields(state, sheet, material);
  return {fields.strain_energy_density[sheet.index(row, column)], P};
}

Results energy_claim(const Subject &subject, unsigned int samples)
{
  const lattice::TriangularLattice sheet = small_sheet(subject);
  Results results;
  const auto add = [&](const std::string &quantity, const std::string &unit, std::optional<double> lattice_value,
                       std::optional<double> continuum_value, std::optional<double> theory, std::optional<double> error,
                       std::optional<double> tolerance)
  {
    results.add(
      {"energy", subject.name + ": " + quantity, unit, lattice_value, continuum_value, theory, error, tolerance});
  };

  double energy_error = 0., stress_error = 0.;
  std::mt19937_64 generator(20061111);
  for (unsigned int sample = 0; sample < samples; ++sample)
  {
    Eigen::Matrix2d F = random_deformation(generator);
    const LatticeResponse measured = homogeneous_response(sheet, subject.material, F);
    const double energy = subject.cauchy_born.energy(to_continuum(F));
    const Eigen::Matrix2d stress = to_lattice(subject.cauchy_born.first_piola_stress(to_continuum(F)));
    energy_error = larger(energy_error, std::abs(measured.energy_density - energy) / std::abs(energy));
    stress_error = larger(stress_error, (measured.first_piola_stress - stress).norm() / stress.norm());
  }
  const std::string count = std::to_string(samples) + " random F";
  add("energy density, Cauchy-Born, largest relative error, " + count, "1", {}, {}, {}, energy_error, equal_formulas);
  add("first Piola stress, Cauchy-Born, largest relative error, " + count, "1", {}, {}, {}, stress_error,
      equal_formulas);

  // Small strain: mu = dP_xy/dF_xy, lambda = dP_xx/dF_yy, both on the lattice, in the isotropic laws, and in closed
  // form.
  const auto lattice_stress = [&](const Eigen::Matrix2d &F)
  { return homogeneous_response(sheet, subject.material, F).first_piola_stress; };
  const auto small_strain_row = [&](const std::string &quantity, const std::string &unit, double lattice_value,
                                    double continuum_value, double theory)
  {
    const double error = std::max(std::abs(lattice_value / theory - 1.), std::abs(continuum_value / theory - 1.));
    add(quantity, unit, lattice_value, continuum_value, theory, error, small_strain_tolerance);
  };
  const double mu = subject.theory.shear_modulus, rho = subject.material.density;
  const double lattice_mu = stress_derivative(lattice_stress, 0, 1)(0, 1);
  const double lattice_lambda = stress_derivative(lattice_stress, 1, 1)(0, 0);
  const auto small_strain_rows = [&](const std::string &name, const continuum::Material &law)
  {
    const auto tangent = law.tangent(to_continuum(Eigen::Matrix2d::Identity()));
    const double continuum_mu = tangent[0][1][0][1], continuum_lambda = tangent[0][0][1][1];
    small_strain_row("mu at F = I, " + name, "Pa", lattice_mu, continuum_mu, mu);
    small_strain_row("lambda at F = I, " + name, "Pa", lattice_lambda, continuum_lambda, mu);
    small_strain_row("c_S at F = I, " + name, "m/s", std::sqrt(lattice_mu / rho), std::sqrt(continuum_mu / rho),
                     subject.theory.shear_speed);
    small_strain_row("c_L at F = I, " + name, "m/s", std::sqrt((lattice_lambda + 2. * lattice_mu) / rho),
                     std::sqrt((continuum_lambda + 2. * continuum_mu) / rho), subject.theory.longitudinal_speed);
  };
  const continuum::MooneyRivlin law(subject.mooney_rivlin.law);
  small_strain_rows("plane-stress Mooney-Rivlin", law);
  small_strain_rows("network", subject.network);

  // The network law leaves out the lattice's dependence on direction and nothing else: it is the mean over rotations of
  // the lattice, and no farther from the lattice than that dependence goes (theory-comparison.md, eq. (H.15)).
  double mean_energy_error = 0., mean_stress_error = 0., energy_share = 0., stress_share = 0.;
  for (unsigned int sample = 0; sample < samples; ++sample)
  {
    const NetworkComparison both(subject, sheet, random_deformation(generator));
    mean_energy_error = larger(mean_energy_error, both.energy_from_mean());
    mean_stress_error = larger(mean_stress_error, both.stress_from_mean());
    energy_share = larger(energy_share, both.energy_error() / both.energy_bound());
    stress_share = larger(stress_share, both.stress_error() / both.stress_bound());
  }
  add("energy density, network against the lattice's mean over rotations, largest relative error, " + count, "1", {},
      {}, {}, mean_energy_error, equal_formulas);
  add("first Piola stress, network against the lattice's mean over rotations, largest relative error, " + count, "1",
      {}, {}, {}, mean_stress_error, equal_formulas);
  add("energy density, network, largest error over the bound of anisotropy, " + count, "1", {}, {}, {}, energy_share,
      1.);
  add("first Piola stress, network, largest error over the bound of anisotropy, " + count, "1", {}, {}, {},
      stress_share, 1.);
  const NetworkComparison stretched(subject, sheet, subject.deformation);
  add("energy density of the loaded sheet, network", "J/m^3", stretched.lattice_energy, stretched.network_energy,
      stretched.energy.mean(0), stretched.energy_error(), stretched.energy_bound());
  add("first Piola stress of the loaded sheet, network, Frobenius norm", "Pa", stretched.lattice_stress.norm(),
      stretched.network_stress.norm(), stretched.stress.mean.norm(), stretched.stress_error(),
      stretched.stress_bound());

  // Finite strain: calibrated, so the difference is reported and not judged; but the law must be usable.
  const LatticeResponse loaded = homogeneous_response(sheet, subject.material, subject.deformation);
  const double loaded_energy = law.energy(to_continuum(subject.deformation));
  add("energy density of the loaded sheet, plane-stress Mooney-Rivlin", "J/m^3", loaded.energy_density, loaded_energy,
      {}, std::abs(loaded_energy / loaded.energy_density - 1.), {});
  add("rms energy residual of plane-stress Mooney-Rivlin along the loading path", "1", {},
      subject.mooney_rivlin.energy_residual, {}, subject.mooney_rivlin.energy_residual, {});
  if (subject.ratio_is_calibrated)
  {
    // The least residual has no slope: a wrong ratio has neighbours that are better. A minimum is flat, so what is left
    // of its location, 1e-9 by golden sections, is seen as a slope of as much times the curvature, which is below 100.
    const lattice::TriangularLattice any = small_sheet(subject);
    const double ratio = subject.mooney_rivlin.ratio;
    constexpr double step = 1e-4;
    const auto residual = [&](double r)
    { return with_ratio(any, subject.material, subject.deformation, r).energy_residual; };
    const double slope = (residual(ratio + step) - residual(ratio - step)) / (2. * step);
    add("calibrated ratio r = C2 / (C1 + C2); error: slope of the residual there", "1", {}, ratio, {}, std::abs(slope),
        1e-5);
  }
  else
    add("given ratio r = C2 / (C1 + C2)", "1", {}, subject.mooney_rivlin.ratio, {}, {}, {});
  // Strong ellipticity: the slowest wave on the path has rho c^2 > 0; the error is how far below zero it falls.
  const double slowest = subject.mooney_rivlin.smallest_acoustic_eigenvalue;
  add("slowest rho c^2 / mu on the path, plane-stress Mooney-Rivlin", "1", {}, slowest, {}, std::max(0., -slowest), 0.);
  return results;
}

} // namespace verification
