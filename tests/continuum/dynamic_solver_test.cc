// Motion of sheets on one rank: waves against their dispersion, orders in time, the energy ledger, and what happens
// when a step cannot be taken.
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace sheets;
using continuum::Conditions;
using continuum::Constitution;
using continuum::DynamicSettings;
using continuum::DynamicSolver;
using continuum::FibreViscosity;
using continuum::StaticSettings;
using continuum::StaticSolver;
using continuum::TimeRule;
using Vector = continuum::Sheet::Vector;
namespace edge = continuum::edge;

namespace
{
const double density = 944.; // [kg/m^3]
const Tensor<2, 2> identity = matrix(1., 0., 0., 1.);

std::shared_ptr<Field> constant(const double x, const double y)
{
  return std::make_shared<Field>([=](const Point<2> &) { return Tensor<1, 2>({x, y}); });
}

Conditions periodic()
{
  Conditions conditions;
  conditions.periodic = {{edge::left, edge::right, 0}, {edge::bottom, edge::top, 1}};
  return conditions;
}

// Along x one wavelength of 1 m and n cells, two of them across.
continuum::Rectangle strip(const unsigned int n)
{
  return {1., 2. / n, n, 2, true, true};
}
const double k_wave = 2. * pi; // [1/m]

std::shared_ptr<Field> wave(const Tensor<1, 2> &polarisation)
{
  return std::make_shared<Field>([=](const Point<2> &X) { return std::cos(k_wave * X[0]) * polarisation; });
}

// Dashpots along the bonds of rubber_network.
FibreViscosity network_viscosity(const double eta)
{
  const continuum::CauchyBorn network = rubber_network();
  std::vector<continuum::FibreDashpot> dashpots;
  for (const auto &family : network.families())
    dashpots.push_back({family.direction, family.weight, eta});
  return FibreViscosity(dashpots);
}

// x.A y over the independent unknowns.
double form(const continuum::Sheet &sheet, const continuum::Sheet::Matrix &A, const Vector &x, const Vector &y)
{
  Vector product = sheet.make_owned();
  A.vmult(product, y);
  double sum = 0.;
  for (const auto i : sheet.owned())
    if (!sheet.continuity().is_constrained(i))
      sum += x(i) * product(i);
  return sum;
}

// omega^2 of the discrete wave at the homogeneous state F that is closest to omega^2 = `expected`: inverse iteration
// from the nodal values of the wave.
double discrete_frequency(const Constitution &laws, const double inertia_length, const Tensor<2, 2> &F,
                          const Tensor<1, 2> &polarisation, const unsigned int degree, const unsigned int n,
                          const double expected)
{
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, strip(n));
  const continuum::Sheet sheet(mesh, laws, degree, periodic());
  Vector owned = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), *affine(F), owned);
  Vector u = sheet.make_ghosted();
  u = owned;
  continuum::Sheet::Matrix K, M, A;
  for (auto *matrix : {&K, &M, &A})
    sheet.make_matrix(sheet.continuity(), *matrix);
  sheet.tangent(u, sheet.continuity(), K);
  sheet.mass(density, inertia_length, sheet.continuity(), M);
  A.add(1., K);
  A.add(-0.9 * expected, M); // not at the eigenvalue, where A is singular
  const continuum::LinearSolver solver(sheet, {}, {});
  Vector x = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), *wave(polarisation), x);
  Vector b = sheet.make_owned();
  // The eigenvalue converges by the square of the ratio of distances to the shift, under 0.1/1.1 here and, next to the
  // second polarisation, which symmetry keeps apart: five take it from 1 % to round-off.
  for (int iteration = 0; iteration < 5; ++iteration)
  {
    M.vmult(b, x);
    for (const auto i : sheet.owned())
      if (sheet.continuity().is_constrained(i))
        b(i) = 0.;
    b.compress(dealii::VectorOperation::insert);
    solver.solve(A, x, b);
    x *= 1. / x.linfty_norm();
    sheet.continuity().distribute(x);
  }
  return form(sheet, K, x, x) / form(sheet, M, x, x);
}

void expect_order_in_space(const Constitution &laws, const double inertia_length, const Tensor<2, 2> &F,
                           const Tensor<1, 2> &polarisation, const double exact, const std::string &name)
{
  // Where the gradient is resolved the order is 2 (p - 1), that of the energy of the error in second derivatives.
  for (const unsigned int degree : {2, 3})
  {
    std::vector<double> errors;
    for (const unsigned int n : {8, 16, 32})
      errors.push_back(
        std::abs(discrete_frequency(laws, inertia_length, F, polarisation, degree, n, exact) / exact - 1.));
    const double order = std::log2(errors[1] / errors[2]);
    EXPECT_NEAR(order, 2. * (degree - 1.), 0.3)
      << name << ", degree " << degree << ", errors " << errors[0] << " " << errors[1] << " " << errors[2];
    testing::Test::RecordProperty(name + ", order of degree " + std::to_string(degree), std::to_string(order));
  }
}

// Everything at once: a moving held edge, a traction, a weak normal gradient, a gradient law, viscosity.
struct Problem
{
  continuum::CauchyBorn law = rubber_network();
  continuum::IsotropicGradient gradient{5e5, 0.02};
  FibreViscosity viscosity = network_viscosity(20.);

  Conditions conditions() const
  {
    Conditions all({{edge::left, affine(matrix(1., 0., 0.3, 1.2))}});
    all.tractions = {{edge::top, constant(0., 1e5)}};
    all.normal_gradients = {{edge::right, constant(0.2, 0.1)}};
    return all;
  }
  // Two derivatives vanish at the start; one period takes 10 ms, that of the slowest mode about 25 ms.
  static double load_factor(const double time) { return std::pow(std::sin(100. * pi * time), 4); }
};

constexpr double final_time = 8e-3;

std::unique_ptr<DynamicSolver> moved(const Mesh &mesh, const Problem &problem, const TimeRule &rule,
                                     const unsigned int n_steps, const bool is_viscous = true)
{
  DynamicSettings settings{final_time / n_steps};
  settings.degree = 2;
  settings.rule = rule;
  auto solver = std::make_unique<DynamicSolver>(mesh, Constitution(problem.law, problem.gradient), problem.conditions(),
                                                continuum::Inertia{density, 0.01}, settings,
                                                is_viscous ? &problem.viscosity : nullptr, Problem::load_factor);
  solver->start();
  solver->run_until(final_time);
  return solver;
}
} // namespace

TEST(DynamicSolver, WavesFollowTheDispersionOfTheIsotropicGradient)
{
  const continuum::CauchyBorn law = rubber_network();
  const double mu = law.tangent(identity)[0][1][0][1];
  const continuum::IsotropicGradient gradient(mu, 0.15);
  const double l_d = 0.05;
  for (const unsigned int i : {0, 1})
  {
    Tensor<1, 2> polarisation;
    polarisation[i] = 1.;
    const double modulus = law.tangent(identity)[i][0][i][0]; // rho c^2
    const double l_s = std::sqrt(gradient.modulus() / modulus);
    const double k2 = k_wave * k_wave;
    const double exact = modulus / density * k2 * (1. + l_s * l_s * k2) / (1. + l_d * l_d * k2);
    expect_order_in_space(Constitution(law, gradient), l_d, identity, polarisation, exact,
                          i == 0 ? "longitudinal" : "shear");
  }
}

TEST(DynamicSolver, WavesFollowTheDispersionOfTheLattice)
{
  // Bonds of an NN and NNN network with d = 0.2 m, so kd = 1.26; see theory.md, section 4.
  const continuum::CauchyBorn law = rubber_network();
  const double d = 0.2;
  const auto bonds = rubber_bonds(d);
  const double l_d = 0.6 * d;
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
      const double exact = (A_2 * k2 + (l_d * l_d * A_2 - A_4) * k2 * k2) / (1. + l_d * l_d * k2) / density;
      Tensor<1, 2> polarisation;
      polarisation[i] = 1.;
      expect_order_in_space(Constitution(law, gradient), l_d, F, polarisation, exact,
                            std::string(F[0][0] > 1. ? "stretched, " : "") + (i == 0 ? "longitudinal" : "shear"));
    }
}

TEST(DynamicSolver, IsOfSecondOrderInTime)
{
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  const Problem problem;
  const auto reference = moved(mesh, problem, TimeRule::average_acceleration(), 640);
  EXPECT_GT(reference->displacement().linfty_norm(), 0.1 * length); // large
  const auto error = [&](const TimeRule &rule, const unsigned int n_steps)
  {
    const auto solver = moved(mesh, problem, rule, n_steps);
    Vector difference = solver->sheet().make_owned();
    Vector exact = solver->sheet().make_owned();
    difference = solver->displacement();
    exact = reference->displacement();
    difference -= exact;
    return difference.l2_norm() / exact.l2_norm();
  };
  for (const TimeRule &rule : {TimeRule::average_acceleration(), TimeRule::generalised_alpha(0.6)})
  {
    const double coarse = error(rule, 40);
    const double fine = error(rule, 80);
    // The reference is itself off by (80/640)^2 of the fine error at most, 0.02 of an order.
    EXPECT_NEAR(std::log2(coarse / fine), 2., 0.15) << coarse << " " << fine;
    RecordProperty("order with gamma " + std::to_string(rule.gamma), std::to_string(std::log2(coarse / fine)));
  }
}

TEST(DynamicSolver, LedgerClosesToSecondOrder)
{
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  const Problem problem;
  for (const bool is_viscous : {true, false})
    for (const TimeRule &rule : {TimeRule::average_acceleration(), TimeRule::generalised_alpha(0.6)})
    {
      const auto coarse = moved(mesh, problem, rule, 40, is_viscous)->ledger();
      const auto fine = moved(mesh, problem, rule, 80, is_viscous)->ledger();
      EXPECT_NEAR(std::log2(std::abs(coarse.imbalance / fine.imbalance)), 2., 0.3)
        << coarse.imbalance << " " << fine.imbalance << " of " << fine.work;
      EXPECT_LT(std::abs(fine.imbalance), 0.01 * fine.work);
      RecordProperty("imbalance over work, gamma " + std::to_string(rule.gamma) + (is_viscous ? ", viscous" : ""),
                     std::to_string(1e6 * fine.imbalance / fine.work) + "e-6");
      EXPECT_GT(fine.micro_kinetic, 0.01 * fine.kinetic);
      EXPECT_LT(fine.micro_kinetic, fine.kinetic);
      if (is_viscous)
      {
        EXPECT_GT(fine.dissipated, 0.05 * fine.work);
      }
      else
      {
        EXPECT_EQ(fine.dissipated, 0.);
      }
    }
}

TEST(DynamicSolver, KeepsTheEnergyOfALongVibration)
{
  // Four bilinear cells with all edges held: one node swings at some 1200/s through 0.2 of a cell, in a potential that
  // is not quadratic. With more nodes energy moves to shorter waves, and the error, (w dt)^2 of it, grows until it has
  // done so.
  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  struct Errors // relative to the energy
  {
    double largest_at_first = 0.; // over 0.1 s
    double largest = 0.;
    double mean_at_first = 0.; // over 0.1 s
    double mean_at_last = 0.;
  };
  const auto errors = [&](const double dt, const unsigned int n_first, const unsigned int n_steps)
  {
    DynamicSettings settings{dt};
    settings.degree = 1;
    settings.relative_tolerance = 1e-9;
    DynamicSolver solver(mesh, law, on_all_edges(constant(0., 0.)), {density, 0.}, settings);
    solver.start(nullptr, constant(15., 4.5)); // of the free node; the edges stay
    const double energy = solver.ledger().kinetic;
    Errors e;
    double smallest = energy;
    for (unsigned int n = 1; n <= n_steps; ++n)
    {
      solver.step();
      const double error = solver.ledger().imbalance / energy;
      e.largest = std::max(e.largest, std::abs(error));
      if (n <= n_first)
        e.mean_at_first += error / n_first;
      if (n == n_first)
        e.largest_at_first = e.largest;
      if (n > n_steps - n_first)
        e.mean_at_last += error / n_first;
      smallest = std::min(smallest, solver.ledger().kinetic);
    }
    EXPECT_LT(smallest, 0.01 * energy); // it does vibrate
    EXPECT_EQ(solver.ledger().dissipated, 0.);
    EXPECT_EQ(solver.ledger().work, 0.);
    return e;
  };
  const Errors coarse = errors(2e-4, 500, 500);
  const Errors fine = errors(1e-4, 1000, 10000);
  // The next term of the error is (w dt)^4: w dt is 0.25 for the coarse step, so 4 to within a few per cent.
  EXPECT_NEAR(coarse.largest_at_first / fine.largest_at_first, 4., 0.2) << fine.largest_at_first;
  // A stationary error has means that differ by the phases at which 0.1 s, some 20 periods, are cut: at most 1/50 of
  // its size. A drift of a thousandth of it in each of 200 periods would be ten times that.
  EXPECT_LT(fine.largest, 1.02 * fine.largest_at_first);
  EXPECT_LT(std::abs(fine.mean_at_last - fine.mean_at_first), 0.02 * fine.largest_at_first);
  RecordProperty("largest error", std::to_string(1e6 * fine.largest) + "e-6");
  RecordProperty("ratio", std::to_string(coarse.largest_at_first / fine.largest_at_first));
  RecordProperty("drift", std::to_string(1e6 * (fine.mean_at_last - fine.mean_at_first)) + "e-6");
}

TEST(DynamicSolver, DampsAStandingWaveAsKelvinTheorySays)
{
  // q'' + 2 g q' + w^2 q = 0 with g = eta k^2 / (2 rho (1 + l_d^2 k^2)), eta the viscous modulus of the polarisation.
  const continuum::CauchyBorn law = rubber_network();
  const FibreViscosity viscosity = network_viscosity(300.);
  const double l_d = 0.05;
  const double rho_effective = density * (1. + l_d * l_d * k_wave * k_wave);
  for (const unsigned int i : {0, 1})
  {
    Tensor<1, 2> polarisation;
    polarisation[i] = 1e-6;
    const double w2 = law.tangent(identity)[i][0][i][0] * k_wave * k_wave / rho_effective;
    const double eta = viscosity.stress_by_rate(identity, Tensor<2, 2>())[i][0][i][0];
    const double g = 0.5 * eta * k_wave * k_wave / rho_effective;
    const double damped = std::sqrt(w2 - g * g);
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle(mesh, strip(8));
    const unsigned int per_period = 100;
    DynamicSettings settings{2. * pi / damped / per_period};
    DynamicSolver solver(mesh, law, periodic(), {density, l_d}, settings, &viscosity);
    solver.start(wave(polarisation));
    Vector initial = solver.sheet().make_owned();
    initial = solver.displacement();
    double dissipated = 0.;
    double smallest = 1.;
    solver.run_until(2. * per_period * settings.time_step,
                     [&]
                     {
                       Vector u = solver.sheet().make_owned();
                       u = solver.displacement();
                       const double t = solver.time();
                       const double exact =
                         std::exp(-g * t) * (std::cos(damped * t) + g / damped * std::sin(damped * t));
                       // Average acceleration is slow by (w dt)^2/12 of the phase, 1/3000, which is 4e-3 after two
                       // periods.
                       EXPECT_NEAR((u * initial) / initial.norm_sqr(), exact, 5e-3);
                       EXPECT_GE(solver.ledger().dissipated, dissipated);
                       dissipated = solver.ledger().dissipated;
                       smallest = std::min(smallest, exact);
                     });
    const double decay = std::exp(-g * solver.time());
    EXPECT_LT(decay, 0.8); // there was something to see
    Vector u = solver.sheet().make_owned();
    u = solver.displacement();
    // At the end of a period the error of the phase is of second order: the decay by itself.
    EXPECT_NEAR((u * initial) / initial.norm_sqr(), decay, 1e-3) << decay;
  }
}

TEST(DynamicSolver, DampsHighFrequenciesOnly)
{
  // The same shear wave, followed with steps that resolve it and with steps far longer than its period.
  const continuum::CauchyBorn law = rubber_network();
  const double w = k_wave * std::sqrt(law.tangent(identity)[1][0][1][0] / density);
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, strip(8));
  // q^2 + (dq/dt)^2/w^2 of the wave's amplitude q, over that at the start. The energy itself would drown in the
  // round-off of W at strains of 1e-5.
  const auto energy_left = [&](const TimeRule &rule, const double dt, const unsigned int n_steps)
  {
    DynamicSettings settings{dt};
    settings.rule = rule;
    DynamicSolver solver(mesh, law, periodic(), {density, 0.}, settings);
    solver.start(wave(Tensor<1, 2>({0., 1e-6})));
    Vector initial = solver.sheet().make_owned();
    initial = solver.displacement();
    for (unsigned int n = 0; n < n_steps; ++n)
      solver.step();
    Vector now = solver.sheet().make_owned();
    now = solver.displacement();
    const double q = (now * initial) / initial.norm_sqr();
    now = solver.velocity();
    const double rate = (now * initial) / initial.norm_sqr();
    return q * q + rate * rate / (w * w);
  };
  // A period in 60 steps, w dt = 0.1. Eight cells of degree 3 have w to 1e-5.
  EXPECT_NEAR(energy_left(TimeRule::generalised_alpha(0.5), 2. * pi / 60. / w, 60), 1., 5e-3);
  EXPECT_NEAR(energy_left(TimeRule::average_acceleration(), 2. * pi / 60. / w, 60), 1., 1e-4);
  // As w dt grows the three eigenvalues of a step all tend to rho_inf: what is left of q after n steps is of the order
  // of n^2 rho_inf^n, 1600 * 2^-40 here, and its square 2e-18 within constants.
  EXPECT_LT(energy_left(TimeRule::generalised_alpha(0.5), 1000. / w, 40), 1e-14);
  EXPECT_NEAR(energy_left(TimeRule::average_acceleration(), 1000. / w, 20), 1., 1e-4);
}

TEST(DynamicSolver, MovesHeldBoundariesWithTheLoadFactor)
{
  // u = sin(w t) H X is an exact motion of any sheet, all edges held, under the body force -rho w^2 H X sin(w t).
  const continuum::CauchyBorn law = rubber_network();
  const double w = 400.;
  const Tensor<2, 2> H = matrix(0.4, 0.2, -0.1, 0.3);
  Conditions conditions(on_all_edges(affine(identity + H)));
  conditions.body_force = continuum::BodyForce{
    std::make_shared<Field>([=](const Point<2> &X) { return -density * w * w * (H * Tensor<1, 2>(X)); })};
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  mesh.begin_active()->set_refine_flag(); // for the sake of hanging nodes
  mesh.execute_coarsening_and_refinement();
  for (const TimeRule &rule : {TimeRule::average_acceleration(), TimeRule::generalised_alpha(0.8)})
  {
    double before = 0.;
    for (const unsigned int n_steps : {50, 100})
    {
      DynamicSettings settings{2. / w / n_steps};
      settings.degree = 2;
      settings.rule = rule;
      DynamicSolver solver(mesh, law, conditions, {density, 0.01}, settings, nullptr,
                           [w](const double t) { return std::sin(w * t); });
      const auto initial = std::make_shared<Field>([=](const Point<2> &X) { return w * (H * Tensor<1, 2>(X)); });
      solver.start(nullptr, initial);
      solver.run_until(2. / w);
      EXPECT_NEAR(solver.time(), 2. / w, 1e-12 / w);
      const double factor = std::sin(2.);
      double error = 0.;
      for (const auto &state : solver.evaluate(scattered_points(5, 5)))
        error = std::max(error, (state.displacement - factor * (H * Tensor<1, 2>(state.X))).norm() / length);
      // Step of w dt = 0.04 and 0.02: errors of the order of its square.
      EXPECT_LT(error, 1e-3);
      if (n_steps == 100)
      {
        EXPECT_NEAR(std::log2(before / error), 2., 0.2);
      }
      before = error;

      // Integral of |H X|^2 over [0, length] x [-height/2, height/2].
      const double xx = length * length / 3.;
      const double yy = height * height / 12.;
      const double mean = (H[0][0] * H[0][0] + H[1][0] * H[1][0]) * xx + (H[0][1] * H[0][1] + H[1][1] * H[1][1]) * yy;
      const double speed = w * std::cos(2.);
      const double kinetic = 0.5 * density * speed * speed * mean * length * height;
      const double micro = 0.5 * density * speed * speed * 1e-4 * H.norm_square() * length * height;
      EXPECT_NEAR(solver.ledger().kinetic, kinetic + micro, 0.01 * kinetic);
      EXPECT_NEAR(solver.ledger().micro_kinetic, micro, 0.01 * micro);
      const double stored = law.energy(identity + factor * H) * length * height;
      EXPECT_NEAR(solver.ledger().stored, stored, 1e-3 * stored);
    }
  }
}

TEST(DynamicSolver, KeepsTheMomentumOfAFreeSheet)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.01);
  const FibreViscosity viscosity = network_viscosity(20.);
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  for (const TimeRule &rule : {TimeRule::average_acceleration(), TimeRule::generalised_alpha(0.5)})
  {
    DynamicSettings settings{1e-4};
    settings.degree = 2;
    settings.rule = rule;
    DynamicSolver solver(mesh, Constitution(law, gradient), {}, {density, 0.01}, settings, &viscosity);
    solver.start(nullptr, std::make_shared<Field>(
                            [](const Point<2> &X) {
                              return Tensor<1, 2>({3. + 150. * X[0], -2. + 100. * X[1]});
                            }));
    const Tensor<1, 2> before = solver.momentum();
    // The mean velocity is that of the middle of the sheet.
    EXPECT_NEAR((before - density * length * height * Tensor<1, 2>({3. + 75. * length, -2.})).norm(), 0.,
                1e-12 * before.norm());
    double impulse = 0.; // that the residuals allowed leave, at most
    for (int n = 0; n < 100; ++n)
    {
      solver.step();
      const auto &last = solver.last_report().iterations.back();
      impulse += settings.time_step * last.tolerance * std::sqrt(solver.sheet().dof_handler().n_dofs());
    }
    EXPECT_GT(solver.displacement().linfty_norm(), 0.1 * length);
    EXPECT_LT(impulse, 1e-8 * before.norm());
    EXPECT_NEAR((solver.momentum() - before).norm(), 0., impulse + 1e-13 * before.norm());
    EXPECT_EQ(solver.ledger().work, 0.);
  }
}

TEST(DynamicSolver, LeavesEquilibriumAtRest)
{
  const continuum::CauchyBorn law = rubber_network();
  DynamicSettings settings{1e-3};
  settings.degree = 2;
  {
    // Stretched and periodic.
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle(mesh, {length, height, 4, 4, true, true});
    DynamicSolver solver(mesh, law, periodic(), {density, 0.}, settings);
    const Tensor<2, 2> F = matrix(2.3, 0.1, 0., 2.8);
    solver.start(affine(F));
    solver.run_until(0.01);
    for (const auto &state : solver.evaluate(scattered_points(5, 5)))
      EXPECT_NEAR((state.F - F).norm(), 0., 1e-10);
    EXPECT_NEAR(solver.ledger().stored, law.energy(F) * length * height, 1e-10 * law.energy(F) * length * height);
  }
  // From a static solution.
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(4, 4));
  const auto conditions = bump_problem(1.5, 1.8, 0.02);
  StaticSettings of_static;
  of_static.degree = 2;
  StaticSolver equilibrium(mesh, law, conditions, of_static);
  equilibrium.solve();
  DynamicSolver solver(mesh, law, conditions, {density, 0.}, settings);
  solver.start(equilibrium.displacement(), solver.sheet().make_owned());
  solver.run_until(0.01);
  Vector difference = solver.sheet().make_owned();
  Vector before = solver.sheet().make_owned();
  difference = solver.displacement();
  before = equilibrium.displacement();
  difference -= before;
  // What the residual of the static solution, 1e-10 of the reactions, can set in motion.
  EXPECT_LT(difference.linfty_norm(), 1e-8 * length);
}

TEST(DynamicSolver, ThrowsWithHistoryAndStaysWhenAStepFails)
{
  // The right edge is pushed through the left one within one step.
  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  DynamicSettings settings{1e-4};
  settings.degree = 1;
  DynamicSolver solver(mesh, law, on_all_edges(affine(matrix(0.5, 0., 0., 1.))), {density, 0.}, settings, nullptr,
                       [](const double t) { return t < 4.5e-4 ? 0. : 3.; });
  EXPECT_THROW(solver.step(), continuum::InvalidInput); // no start
  solver.start();
  try
  {
    solver.run_until(1e-3);
    FAIL() << "went on";
  }
  catch (const continuum::SolverFailed &failure)
  {
    ASSERT_EQ(failure.report().load_steps.size(), 1u);
    EXPECT_FALSE(failure.report().load_steps.back().accepted);
    EXPECT_EQ(failure.report().load_steps.back().number, 5u);
    EXPECT_NE(std::string(failure.what()).find("det F"), std::string::npos) << failure.what();
  }
  EXPECT_NEAR(solver.time(), 4e-4, 1e-15);
  EXPECT_EQ(solver.load_factor(), 0.);
  EXPECT_LT(solver.displacement().linfty_norm(), 1e-15 * length); // round-off of the stress at F = I
}

TEST(DynamicSolver, NewtonIsQuadraticWithViscosityAtFiniteStrain)
{
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(4, 4));
  const Problem problem;
  DynamicSettings settings{2e-3}; // long, so that the predictor is far off
  settings.degree = 2;
  settings.rule = TimeRule::generalised_alpha(0.7);
  const FibreViscosity viscosity = network_viscosity(200.);
  DynamicSolver solver(mesh, Constitution(problem.law, problem.gradient), problem.conditions(), {density, 0.01},
                       settings, &viscosity, Problem::load_factor);
  solver.start();
  double best = 0.;
  for (int n = 0; n < 4; ++n)
  {
    solver.step();
    std::vector<double> r;
    for (const auto &iteration : solver.last_report().iterations)
      if (iteration.iteration == 0 || iteration.residual > 100. * iteration.tolerance)
        r.push_back(iteration.residual);
    if (r.size() >= 3)
    {
      const std::size_t m = r.size();
      best = std::max(best, std::log(r[m - 1] / r[m - 2]) / std::log(r[m - 2] / r[m - 3]));
    }
    EXPECT_LE(solver.last_report().iterations.size(), 8u) << solver.last_report().text();
  }
  EXPECT_GE(best, 1.7) << solver.last_report().text();
}

TEST(DynamicSolver, RefusesImpossibleInput)
{
  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(2, 2));
  const auto refuses = [&](const continuum::Inertia &inertia, const DynamicSettings &settings)
  { EXPECT_THROW(DynamicSolver(mesh, law, {}, inertia, settings), continuum::InvalidInput); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuses({0., 0.}, {1e-3});
  refuses({density, -1.}, {1e-3});
  refuses({density, nan}, {1e-3});
  refuses({density, 0.}, {0.});
  refuses({density, 0.}, {nan});
  DynamicSettings settings{1e-3};
  settings.relative_tolerance = 1.;
  refuses({density, 0.}, settings);
  settings = {1e-3};
  settings.rule.gamma = 0.6; // first order
  refuses({density, 0.}, settings);
  settings = {1e-3};
  settings.rule.beta = 1. / 6.; // linear acceleration: not stable for every step
  refuses({density, 0.}, settings);
  EXPECT_THROW(TimeRule::generalised_alpha(-0.1), continuum::InvalidInput);
  EXPECT_THROW(TimeRule::generalised_alpha(1.1), continuum::InvalidInput);

  // A held edge that is not where the load factor puts it, fields of one component, a load factor that is none.
  DynamicSolver held(mesh, law, {{edge::left, constant(0.01, 0.)}}, {density, 0.}, {1e-3});
  EXPECT_THROW(held.start(), continuum::InvalidInput);
  EXPECT_NO_THROW(held.start(constant(0.01, 0.)));
  DynamicSolver free(mesh, law, {}, {density, 0.}, {1e-3});
  EXPECT_THROW(free.start(std::make_shared<dealii::Functions::ZeroFunction<2>>(1)), continuum::InvalidInput);
  EXPECT_THROW(free.start(Vector(), Vector()), continuum::InvalidInput);
  DynamicSolver undefined(mesh, law, {}, {density, 0.}, {1e-3}, nullptr, [nan](double) { return nan; });
  EXPECT_THROW(undefined.start(), continuum::InvalidInput);
  Mesh narrow(MPI_COMM_SELF);
  EXPECT_THROW(continuum::make_rectangle(narrow, {1., 1., 1, 2, true, false}), continuum::InvalidInput);
}
