// Waves in sheets on one rank, compared with theoretical dispersion and damping.
#include "moving_sheets.h"

#include <deal.II/numerics/vector_tools_interpolate.h>

#include <gtest/gtest.h>

#include <cmath>

namespace dynamic_waves_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::Constitution;
using continuum::DynamicSettings;
using continuum::DynamicSolver;
using continuum::FibreViscosity;
using continuum::NewmarkParameters;
using Vector = continuum::Sheet::Vector;

// Returns x.A y over the independent unknowns.
double form(const continuum::Sheet &sheet, const continuum::Sheet::Matrix &A, const Vector &x, const Vector &y)
{
  Vector product = sheet.make_owned();
  A.vmult(product, y);
  double sum = 0.;
  for (const auto i : sheet.owned())
    if (!sheet.conformity_constraints().is_constrained(i))
      sum += x(i) * product(i);
  return sum;
}

// Returns omega^2 of the discrete wave at the homogeneous state F closest to omega^2 = `expected`, by inverse iteration
// from the nodal values of the wave.
double discrete_frequency(const Constitution &laws, const double inertia_length, const Tensor<2, 2> &F,
                          const Tensor<1, 2> &polarisation, const unsigned int degree, const unsigned int n,
                          const double expected)
{
  RectangleMesh mesh(strip(n));
  const continuum::Sheet sheet(mesh, laws, degree, periodic());
  Vector owned = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), *affine(F), owned);
  Vector u = sheet.make_ghosted();
  u = owned;
  continuum::Sheet::Matrix K, M, A;
  for (auto *matrix : {&K, &M, &A})
    sheet.make_matrix(sheet.conformity_constraints(), *matrix);
  sheet.tangent(u, sheet.conformity_constraints(), K);
  sheet.add_mass(density, inertia_length, sheet.conformity_constraints(), M);
  A.add(1., K);
  A.add(-0.9 * expected, M); // shifted away from the eigenvalue, where A is singular
  continuum::DirectSolver solver;
  solver.factorise(A);
  Vector x = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), *wave(polarisation), x);
  Vector b = sheet.make_owned();
  // The eigenvalue converges with the square of the ratio of distances to the shift, below 0.1/1.1 here; symmetry
  // separates the second polarisation. Five iterations reduce the error from 1 % to round-off.
  for (int iteration = 0; iteration < 5; ++iteration)
  {
    M.vmult(b, x);
    for (const auto i : sheet.owned())
      if (sheet.conformity_constraints().is_constrained(i))
        b(i) = 0.;
    b.compress(dealii::VectorOperation::insert);
    solver.solve(x, b);
    x *= 1. / x.linfty_norm();
    sheet.conformity_constraints().distribute(x);
  }
  return form(sheet, K, x, x) / form(sheet, M, x, x);
}

void expect_order_in_space(const Constitution &laws, const double inertia_length, const Tensor<2, 2> &F,
                           const unsigned int component, const double exact)
{
  Tensor<1, 2> polarisation;
  polarisation[component] = 1.;
  // If the gradient is resolved, the order is 2 (p - 1), that of the energy of the error in second derivatives.
  for (const unsigned int degree : {2, 3})
  {
    const auto error = [&](const unsigned int n)
    { return std::abs(discrete_frequency(laws, inertia_length, F, polarisation, degree, n, exact) / exact - 1.); };
    EXPECT_NEAR(std::log2(error(16) / error(32)), 2. * (degree - 1.), 0.3)
      << "F_11 = " << F[0][0] << ", component " << component << ", degree " << degree;
  }
}

// theory-continuum.md, eq. (C.47).
TEST(DynamicSolver, WavesFollowTheDispersionOfTheIsotropicGradient)
{
  const continuum::CauchyBorn law = rubber_network();
  const double mu = law.tangent(identity)[0][1][0][1];
  const continuum::IsotropicGradient gradient(mu, 0.15);
  const double l_d = 0.05;
  for (const unsigned int i : {0, 1})
  {
    const double modulus = law.tangent(identity)[i][0][i][0]; // rho c^2
    const double l_s2 = gradient.modulus() / modulus, k2 = k_wave * k_wave;
    expect_order_in_space(Constitution(law, gradient), l_d, identity, i,
                          modulus / density * k2 * (1. + l_s2 * k2) / (1. + l_d * l_d * k2));
  }
}

// theory-continuum.md, eq. (C.47).
TEST(DynamicSolver, WavesFollowTheDispersionOfTheLattice)
{
  // Bonds of an NN and NNN network with d = 0.2 m, so kd = 1.26.
  const continuum::CauchyBorn law = rubber_network();
  const auto bonds = rubber_bonds(0.2);
  const double l_d = 0.12;
  const continuum::LatticeGradient gradient(bonds, l_d);
  for (const Tensor<2, 2> &F : {identity, matrix(2.3, 0., 0., 2.8)})
    for (const unsigned int i : {0, 1})
    {
      // rho omega^2 = (A_2 k^2 + (l_d^2 A_2 - A_4) k^4)/(1 + l_d^2 k^2) with A_2 and A_4 sums over bonds; F is along
      // the axes, and so are the polarisations.
      double A_2 = 0.;
      double A_4 = 0.;
      for (const auto &bond : bonds)
      {
        const Tensor<1, 2> &N = bond.fibre.direction;
        const Tensor<1, 2> f = F * N;
        const double l = f.norm();
        const auto psi = continuum::derivatives(bond.fibre.potential, l);
        const double along = f[i] * f[i] / (l * l);
        const double stiffness = bond.fibre.weight * (psi.second * along + psi.first / l * (1. - along));
        A_2 += stiffness * N[0] * N[0];
        A_4 += stiffness * bond.length * bond.length / 12. * std::pow(N[0], 4);
      }
      const double k2 = k_wave * k_wave;
      expect_order_in_space(Constitution(law, gradient), l_d, F, i,
                            (A_2 * k2 + (l_d * l_d * A_2 - A_4) * k2 * k2) / (1. + l_d * l_d * k2) / density);
    }
}

// theory-continuum.md, eq. (C.62).
TEST(DynamicSolver, DampsAStandingWaveAsKelvinTheorySays)
{
  // q'' + 2 g q' + w^2 q = 0 with g = eta k^2 / (2 rho (1 + l_d^2 k^2)), eta the viscous modulus of the polarisation,
  // and (l_d^2 eta - eta_4) k^4 added to eta k^2 for gradient energy and viscosity of bonds of 0.6 d = l_d, kd = 1.26.
  const continuum::CauchyBorn law = rubber_network();
  constexpr double l_d = 0.12, bond_viscosity = 600.;
  const auto bonds = rubber_bonds(l_d / 0.6);
  const continuum::LatticeGradient gradient(bonds, l_d);
  const FibreViscosity viscosity = network_viscosity(bond_viscosity, l_d);
  const double rho_effective = density * (1. + l_d * l_d * k_wave * k_wave);
  for (const unsigned int i : {0, 1})
  {
    Tensor<1, 2> polarisation;
    polarisation[i] = 1e-6;
    double stiffness = law.tangent(identity)[i][0][i][0];
    double eta = 0.;
    double stiffness_4 = 0.;
    double eta_4 = 0.;
    for (const auto &bond : bonds)
    {
      const Tensor<1, 2> &N = bond.fibre.direction;
      const double along = bond.fibre.weight * bond.length * bond.length / 12. * std::pow(N[0], 4) * N[i] * N[i];
      stiffness_4 += along * continuum::derivatives(bond.fibre.potential, 1.).second;
      eta += bond.fibre.weight * bond_viscosity * N[0] * N[0] * N[i] * N[i];
      eta_4 += along * bond_viscosity;
    }
    stiffness += (l_d * l_d * stiffness - stiffness_4) * k_wave * k_wave;
    eta += (l_d * l_d * eta - eta_4) * k_wave * k_wave;
    const double w2 = stiffness * k_wave * k_wave / rho_effective;
    const double g = 0.5 * eta * k_wave * k_wave / rho_effective;
    const double damped = std::sqrt(w2 - g * g);
    RectangleMesh mesh(strip(8));
    const unsigned int per_period = 100;
    DynamicSettings settings{2. * pi / damped / per_period};
    DynamicSolver solver(mesh, Constitution(law, gradient), periodic(), {density, l_d}, settings, &viscosity);
    start(solver, wave(polarisation));
    const Vector initial = owned(solver.sheet(), solver.displacement());
    const auto amplitude = [&]
    { return (owned(solver.sheet(), solver.displacement()) * initial) / initial.norm_sqr(); };
    double dissipated = 0.;
    run_until(solver, 0.5 * per_period * settings.time_step,
              [&]
              {
                const double t = solver.time();
                const double exact = std::exp(-g * t) * (std::cos(damped * t) + g / damped * std::sin(damped * t));
                // The phase of average acceleration lags by a fraction (w dt)^2/12 = 1/3000, which is 1e-3 after
                // half a period.
                EXPECT_NEAR(amplitude(), exact, 5e-3);
                EXPECT_GE(solver.ledger().dissipated, dissipated);
                dissipated = solver.ledger().dissipated;
              });
    const double decay = std::exp(-g * solver.time());
    EXPECT_LT(decay, 0.9); // the damping is measurable
    // After half a period the error of the phase has a second-order effect, so only the decay matters.
    EXPECT_NEAR(amplitude(), -decay, 5e-4) << decay;
  }
}

// theory-continuum.md, eq. (C.44).
TEST(DynamicSolver, DampsHighFrequenciesOnly)
{
  // A shear wave with time steps that resolve it, and with steps much longer than its period.
  const continuum::CauchyBorn law = rubber_network();
  const double w = k_wave * std::sqrt(law.tangent(identity)[1][0][1][0] / density);
  RectangleMesh mesh(strip(8));
  // Returns q^2 + (dq/dt)^2/w^2 of the amplitude q of the wave, relative to the start. The energy itself would be lost
  // in the round-off of W at strains of 1e-5.
  const auto energy_left = [&](const NewmarkParameters &rule, const double dt, const unsigned int n_steps)
  {
    DynamicSettings settings{dt};
    settings.rule = rule;
    DynamicSolver solver(mesh, law, periodic(), {density, 0.}, settings);
    start(solver, wave(Tensor<1, 2>({0., 1e-6})));
    const Vector initial = owned(solver.sheet(), solver.displacement());
    for (unsigned int n = 0; n < n_steps; ++n)
      solver.step();
    const double q = (owned(solver.sheet(), solver.displacement()) * initial) / initial.norm_sqr();
    const double rate = (owned(solver.sheet(), solver.velocity()) * initial) / initial.norm_sqr();
    return q * q + rate * rate / (w * w);
  };
  // A period in 60 steps, w dt = 0.1. Eight cells of degree 3 give w to 1e-5.
  EXPECT_NEAR(energy_left(NewmarkParameters::generalised_alpha(0.5), 2. * pi / 60. / w, 60), 1., 5e-3);
  EXPECT_NEAR(energy_left(NewmarkParameters::average_acceleration(), 2. * pi / 60. / w, 60), 1., 1e-4);
  // For large w dt the three eigenvalues of a step all tend to rho_inf: after n steps q is of the order of n^2
  // rho_inf^n, 1600 * 2^-40 here, and its square 2e-18 up to constants.
  EXPECT_LT(energy_left(NewmarkParameters::generalised_alpha(0.5), 1000. / w, 40), 1e-14);
  EXPECT_NEAR(energy_left(NewmarkParameters::average_acceleration(), 1000. / w, 20), 1., 1e-4);
}

} // namespace dynamic_waves_test
