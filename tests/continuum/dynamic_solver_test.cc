// Dynamics of sheets on one rank: orders in time, energy balance, units, and steps that do not converge.
#include "continuum/errors.h"
#include "moving_sheets.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace dynamic_solver_test
{

using namespace latcon;
using namespace moving_sheets;
using namespace latcon::continuum;
using Vector = Sheet::Vector;

const CauchyBorn law = rubber_network();
const auto average_acceleration = NewmarkParameters::average_acceleration();
const auto generalised_alpha = NewmarkParameters::generalised_alpha(0.6);

constexpr double final_time = 8e-3;
const FibreViscosity dashpots = network_viscosity(80., 0.01);

std::unique_ptr<DynamicSolver> moved(const Mesh &mesh, const Problem &problem, const NewmarkParameters &rule,
                                     const unsigned int n_steps, const bool is_viscous = true)
{
  const DynamicSettings settings = quadratic(final_time / n_steps, rule);
  auto solver = std::make_unique<DynamicSolver>(mesh, Constitution(problem.law, problem.gradient), problem.held(),
                                                Inertia{density, 0.01}, settings, is_viscous ? &dashpots : nullptr);
  start(*solver, nullptr, Problem::velocity());
  run_until(*solver, final_time);
  return solver;
}

// theory-continuum.md, eqs. (C.40), (C.43), (C.44) and (C.46).
TEST(DynamicSolver, IsOfSecondOrderInTimeWithItsLedger)
{
  RectangleMesh mesh(rectangle(2, 2));
  const Problem problem;
  // Extrapolated from two steps, so that the error left is of the fourth order.
  const auto half = moved(mesh, problem, average_acceleration, 80),
             quarter = moved(mesh, problem, average_acceleration, 160);
  EXPECT_GT(quarter->displacement().linfty_norm(), 0.1 * length); // large
  Vector exact = owned(quarter->sheet(), quarter->displacement());
  exact.sadd(4. / 3., -1. / 3., owned(half->sheet(), half->displacement()));
  const auto error = [&](const DynamicSolver &solver)
  {
    Vector difference = owned(solver.sheet(), solver.displacement());
    difference -= exact;
    return difference.l2_norm() / exact.l2_norm();
  };
  const auto expect_second_order = [&](const DynamicSolver &coarse, const DynamicSolver &fine, const bool is_viscous)
  {
    if (is_viscous)
    {
      EXPECT_NEAR(std::log2(error(coarse) / error(fine)), 2., 0.15) << error(coarse) << " " << error(fine);
    }
    const EnergyLedger &ledger = fine.ledger();
    EXPECT_NEAR(std::log2(std::abs(coarse.ledger().imbalance / ledger.imbalance)), 2., 0.3)
      << coarse.ledger().imbalance << " " << ledger.imbalance;
    const double energy = ledger.stored + ledger.kinetic + ledger.dissipated;
    EXPECT_LT(std::abs(ledger.imbalance), 0.01 * energy);
    EXPECT_GT(ledger.micro_kinetic, 0.01 * ledger.kinetic);
    EXPECT_LT(ledger.micro_kinetic, ledger.kinetic);
    EXPECT_EQ(ledger.dissipated > 0.05 * energy, is_viscous) << ledger.dissipated << " of " << energy;
    EXPECT_EQ(ledger.dissipated == 0., !is_viscous);
  };
  expect_second_order(*moved(mesh, problem, average_acceleration, 40), *half, true);
  for (const bool is_viscous : {true, false})
    expect_second_order(*moved(mesh, problem, generalised_alpha, 40, is_viscous),
                        *moved(mesh, problem, generalised_alpha, 80, is_viscous), is_viscous);
}

// A large motion ends at the same place. In short steps a kept tangent takes more iterations, in long ones it is soon
// replaced.
TEST(DynamicSolver, MayKeepItsTangentFromStepToStep)
{
  RectangleMesh mesh(rectangle(2, 2));
  const Problem problem;
  for (const int n_steps : {80, 10})
  {
    std::array<Vector, 2> end;
    std::array<std::size_t, 2> n_iterations{};
    for (const std::size_t keeps : {0, 1})
    {
      DynamicSettings settings = quadratic(final_time / n_steps, average_acceleration);
      settings.keeps_tangent = keeps == 1;
      DynamicSolver solver(mesh, Constitution(problem.law, problem.gradient), problem.held(), Inertia{density, 0.01},
                           settings, &dashpots);
      start(solver, nullptr, Problem::velocity());
      for (int n = 0; n < n_steps; ++n)
      {
        solver.step();
        n_iterations[keeps] += solver.last_report().iterations.size();
      }
      EXPECT_EQ(solver.n_divided_steps(), 0u);
      end[keeps] = owned(solver.sheet(), solver.displacement());
    }
    const double size = end[0].l2_norm();
    end[1] -= end[0];
    EXPECT_LT(end[1].l2_norm(), n_steps * 1e-10 * size); // of the tolerance of each step
    EXPECT_EQ(n_iterations[1] > n_iterations[0], n_steps == 80) << n_iterations[1] << " and " << n_iterations[0];
  }
}

TEST(DynamicSolver, KeepsTheMomentumOfAFreeSheet)
{
  const IsotropicGradient gradient(5e5, 0.01);
  const FibreViscosity viscosity = network_viscosity(20.);
  RectangleMesh mesh(rectangle(2, 2));
  for (const NewmarkParameters &rule : {average_acceleration, generalised_alpha})
  {
    const DynamicSettings settings = quadratic(1e-4, rule);
    DynamicSolver solver(mesh, Constitution(law, gradient), {}, {density, 0.01}, settings, &viscosity);
    start(solver, nullptr,
          std::make_shared<Field>(
            [](const Point<2> &X) {
              return Tensor<1, 2>({3. + 150. * X[0], -2. + 100. * X[1]});
            }));
    const Tensor<1, 2> before = momentum(solver);
    // The mean velocity is that of the middle of the sheet.
    EXPECT_NEAR((before - density * length * height * Tensor<1, 2>({3. + 75. * length, -2.})).norm(), 0.,
                1e-12 * before.norm());
    double impulse = 0.; // upper bound from the tolerances of the residuals
    for (int n = 0; n < 100; ++n)
    {
      solver.step();
      const auto &last = solver.last_report().iterations.back();
      impulse += settings.time_step * last.tolerance * std::sqrt(solver.sheet().dof_handler().n_dofs());
    }
    EXPECT_GT(solver.displacement().linfty_norm(), 0.1 * length);
    EXPECT_LT(impulse, 1e-8 * before.norm());
    EXPECT_NEAR((momentum(solver) - before).norm(), 0., impulse + 1e-13 * before.norm());
    EXPECT_EQ(solver.ledger().work, 0.);
  }
}

TEST(DynamicSolver, StartsWithTheAccelerationOfItsLoads)
{
  BoundaryConditions conditions;
  conditions.body_force = BodyForce{constant(3. * density, -2. * density)};
  RectangleMesh mesh(rectangle(2, 2));
  DynamicSolver solver(mesh, law, conditions, {density, 0.}, quadratic(1e-4));
  start(solver);
  Vector difference = owned(solver.sheet(), solver.acceleration());
  difference -= owned(solver.sheet(), nodal(solver.sheet(), [](const Point<2> &) { return Tensor<1, 2>({3., -2.}); }));
  EXPECT_LT(difference.linfty_norm(), 1e-10);
}

// theory-continuum.md, eq. (C.45).
TEST(DynamicSolver, LeavesEquilibriumAtRest)
{
  RectangleMesh mesh(rectangle(4, 4));
  const auto conditions = bump_problem(1.5, 1.8, 0.02);
  StaticSettings of_static;
  of_static.degree = 2;
  StaticSolver equilibrium(mesh, law, conditions, of_static);
  equilibrium.solve();
  DynamicSolver solver(mesh, law, conditions, {density, 0.}, quadratic(1e-3));
  solver.start(equilibrium.displacement(), solver.sheet().make_owned());
  run_until(solver, 0.01);
  Vector difference = owned(solver.sheet(), solver.displacement());
  difference -= owned(equilibrium.sheet(), equilibrium.displacement());
  // Motion that the residual of the static solution, 1e-10 of the reactions, can cause.
  EXPECT_LT(difference.linfty_norm(), 1e-8 * length);
}

// Sheet that moves freely, of a law that refuses.
struct Refusing
{
  explicit Refusing(const unsigned int halvings) : mesh(rectangle(2, 2)), settings(quadratic(1e-4))
  {
    settings.max_step_halvings = halvings;
    solver = std::make_unique<DynamicSolver>(mesh, refusing, BoundaryConditions(), Inertia{density}, settings);
  }

  RefusingNetwork refusing;
  RectangleMesh mesh;
  DynamicSettings settings;
  std::unique_ptr<DynamicSolver> solver;
};

TEST(DynamicSolver, ThrowsWithHistoryAndStaysWhenAStepFails)
{
  Refusing refusing(4);
  DynamicSolver &solver = *refusing.solver;
  EXPECT_THROW(solver.step(), InvalidInput); // no start
  start(solver, nullptr, Problem::velocity());
  run_until(solver, 4e-4);
  const Vector before = solver.displacement();
  const EnergyLedger ledger = solver.ledger();
  refusing.refusing.refusals = 1000000;
  try
  {
    solver.step();
    FAIL() << "went on";
  }
  catch (const SolverFailed &failure)
  {
    // The whole step, its first half, and so on down to a sixteenth.
    ASSERT_EQ(failure.report().load_steps.size(), 5u);
    EXPECT_FALSE(failure.report().load_steps.front().accepted);
    EXPECT_FALSE(failure.report().load_steps.back().accepted);
    EXPECT_EQ(failure.report().load_steps.back().number, 5u);
    EXPECT_NE(std::string(failure.what()).find("det F"), std::string::npos) << failure.what();
  }
  EXPECT_NEAR(solver.time(), 4e-4, 1e-15);
  for (const auto i : solver.sheet().owned())
    EXPECT_EQ(solver.displacement()(i), before(i));
  EXPECT_EQ(solver.ledger().stored, ledger.stored);
  EXPECT_EQ(solver.n_divided_steps(), 0u);

  // The largest of forces that are beyond all numbers is in the corner that moves.
  DynamicSettings linear{1e-4};
  linear.degree = 1;
  DynamicSolver beyond(refusing.mesh, law, {}, {density, 0.}, linear);
  start(beyond, nullptr,
        std::make_shared<Field>(
          [](const Point<2> &X) {
            return Tensor<1, 2>({0., X[0] > 0.8 * length && X[1] > 0.3 * height ? 3e153 : 0.});
          }));
  const std::string message = message_of<SolverFailed>([&] { beyond.step(); });
  EXPECT_NE(message.find("not finite at X = (0.15, 0.05) m"), std::string::npos) << message;
  // Each iteration is one of its own attempt.
  DynamicSettings hasty = quadratic(1e-4);
  hasty.max_newton_iterations = 0;
  hasty.max_step_halvings = 1;
  DynamicSolver hasty_solver(refusing.mesh, law, BoundaryConditions(), Inertia{density}, hasty);
  start(hasty_solver, nullptr, Problem::velocity());
  try
  {
    hasty_solver.step();
    FAIL() << "no iteration was enough";
  }
  catch (const SolverFailed &failure)
  {
    EXPECT_EQ(failure.report().iterations.back().load_step, 2u) << failure.report().text();
  }
}

// Both predictors of a whole step are refused. Its halves are solved, whole steps follow, and the energy balance over
// the parts closes.
TEST(DynamicSolver, DividesAStepThatCannotBeSolved)
{
  const auto moved = [](const unsigned int halvings)
  {
    Refusing refusing(halvings);
    DynamicSolver &solver = *refusing.solver;
    start(solver, nullptr, Problem::velocity());
    solver.step();
    refusing.refusing.refusals = 2;
    run_until(solver, 5e-4);
    EXPECT_NEAR(solver.time(), 5e-4, 1e-15);
    return std::tuple(solver.n_divided_steps(), solver.ledger(), solver.last_report().load_steps.size());
  };
  EXPECT_THROW(moved(0), SolverFailed);
  const auto [n_divided, ledger, attempts] = moved(4);
  EXPECT_EQ(n_divided, 1u);
  EXPECT_EQ(attempts, 1u); // the last step is not divided
  EXPECT_LT(std::abs(ledger.imbalance), 0.01 * (ledger.stored + ledger.kinetic));
}

// theory-continuum.md, eq. (C.44).
TEST(DynamicSolver, DampsHighFrequenciesOnly)
{
  // A shear wave of one wavelength, 1 m, with time steps that resolve it, and with steps much longer than its period.
  const double k = 2. * pi, w = k * std::sqrt(law.tangent(identity)[1][0][1][0] / density);
  RectangleMesh mesh({1., 0.25, 8, 2, true, true});
  const auto wave = std::make_shared<Field>(
    [=](const Point<2> &X) {
      return 1e-6 * std::cos(k * X[0]) * Tensor<1, 2>({0., 1.});
    });
  // Returns q^2 + (dq/dt)^2/w^2 of the amplitude q of the wave, relative to the start. The energy itself would be lost
  // in the round-off of W at strains of 1e-5.
  const auto energy_left = [&](const NewmarkParameters &rule, const double dt, const unsigned int n_steps)
  {
    DynamicSettings settings{dt};
    settings.rule = rule;
    DynamicSolver solver(mesh, law, periodic(), {density, 0.}, settings);
    start(solver, wave);
    const Vector initial = owned(solver.sheet(), solver.displacement());
    for (unsigned int n = 0; n < n_steps; ++n)
      solver.step();
    const double q = (owned(solver.sheet(), solver.displacement()) * initial) / initial.norm_sqr();
    const double rate = (owned(solver.sheet(), solver.velocity()) * initial) / initial.norm_sqr();
    return q * q + rate * rate / (w * w);
  };
  // A period in 60 steps, w dt = 0.1. Eight cells of degree 3 give w to 1e-5.
  EXPECT_NEAR(energy_left(NewmarkParameters::generalised_alpha(0.5), 2. * pi / 60. / w, 60), 1., 5e-3);
  EXPECT_NEAR(energy_left(average_acceleration, 2. * pi / 60. / w, 60), 1., 1e-4);
  // For large w dt the three eigenvalues of a step all tend to rho_inf: after n steps q is of the order of n^2
  // rho_inf^n, 1600 * 2^-40 here, and its square 2e-18 up to constants.
  EXPECT_LT(energy_left(NewmarkParameters::generalised_alpha(0.5), 1000. / w, 40), 1e-14);
  EXPECT_NEAR(energy_left(average_acceleration, 1000. / w, 20), 1., 1e-4);
}

// Units of a sheet relative to those of another one. The equation of motion, r u / t^2 = e / l, determines the unit of
// time; a viscosity is a stress times a time.
struct Units
{
  double length, stress, density;
  double time() const { return length * std::sqrt(density / stress); }
};

// Sheet with all quantities that have units: mass with micro-inertia, both laws, dashpots, a held edge, a traction, a
// weak normal gradient.
struct MovingSheet
{
  explicit MovingSheet(const Units &units)
    : network(rubber_network(units.stress * 1e5, units.stress * 1.5e5)),
      gradient(units.stress * 5e5, units.length * 0.02),
      viscosity(network_viscosity(units.stress * units.time() * 20., units.length * 0.01)),
      mesh({units.length * length, units.length * height, 2, 2})
  {
    BoundaryConditions conditions = Problem().conditions();
    conditions.tractions = {{edge::top, constant(0., units.stress * 1e5)}};
    const double t = units.time();
    solver = std::make_unique<DynamicSolver>(mesh, Constitution(network, gradient), conditions,
                                             Inertia{units.density * density, units.length * 0.01},
                                             quadratic(t * 2e-4, generalised_alpha), &viscosity);
    start(*solver);
    for (unsigned int n = 0; n < 20; ++n)
      solver->step();
  }

  CauchyBorn network;
  IsotropicGradient gradient;
  FibreViscosity viscosity;
  RectangleMesh mesh;
  std::unique_ptr<DynamicSolver> solver;
};

// All units are powers of two, so both runs have equal mantissas everywhere: in the elements, in the factors of the
// matrix and in all compared norms.
TEST(DynamicSolver, DoesNotDependOnUnits)
{
  const MovingSheet one_sheet({1., 1., 1.});
  const auto &one = one_sheet.solver;
  EXPECT_GT(one->displacement().linfty_norm(), 0.01 * length);
  EXPECT_NE(one->ledger().dissipated, 0.);
  EXPECT_LT(std::abs(one->ledger().imbalance), 0.05 * one->ledger().work);
  for (const Units &units : {Units{4., 1., 1.}, Units{1., 4., 16.}, Units{0.5, 16., 4.}})
  {
    const MovingSheet other_sheet(units);
    const auto &other = other_sheet.solver;
    const double l = units.length, per_energy = 1. / (units.stress * l * l);
    for (const auto i : one->displacement().locally_owned_elements())
    {
      ASSERT_EQ(other->displacement()(i), l * one->displacement()(i));
      ASSERT_EQ(other->velocity()(i), l / units.time() * one->velocity()(i));
    }
    EXPECT_EQ(per_energy * other->ledger().stored, one->ledger().stored);
    EXPECT_EQ(per_energy * other->ledger().kinetic, one->ledger().kinetic);
    EXPECT_EQ(per_energy * other->ledger().micro_kinetic, one->ledger().micro_kinetic);
    EXPECT_EQ(per_energy * other->ledger().dissipated, one->ledger().dissipated);
    EXPECT_EQ(per_energy * other->ledger().work, one->ledger().work);
  }
}

TEST(DynamicSolver, RefusesImpossibleInput)
{
  RectangleMesh mesh(rectangle(2, 2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DynamicSettings loose{1e-3}, first_order{1e-3}, conditionally_stable{1e-3};
  loose.relative_tolerance = 1.;
  first_order.rule.gamma = 0.6;
  conditionally_stable.rule.beta = 1. / 6.; // linear acceleration
  for (const auto &[inertia, settings] :
       std::vector<std::pair<Inertia, DynamicSettings>>{{{0., 0.}, {1e-3}},
                                                        {{density, -1.}, {1e-3}},
                                                        {{density, nan}, {1e-3}},
                                                        {{density, 0.}, {0.}},
                                                        {{density, 0.}, {nan}},
                                                        {{density, 0.}, loose},
                                                        {{density, 0.}, first_order},
                                                        {{density, 0.}, conditionally_stable}})
    EXPECT_THROW(DynamicSolver(mesh, law, {}, inertia, settings), InvalidInput);
  EXPECT_THROW(NewmarkParameters::generalised_alpha(-0.1), InvalidInput);
  EXPECT_THROW(NewmarkParameters::generalised_alpha(1.1), InvalidInput);

  // A held edge that is not at the prescribed position, vectors of another sheet, values that are not finite.
  DynamicSolver held(mesh, law, {{edge::left, constant(0.01, 0.)}}, {density, 0.}, {1e-3});
  EXPECT_THROW(start(held), InvalidInput);
  EXPECT_THROW(start(held, constant(0.01 + 1e-8, 0.)), InvalidInput); // 6e-8 of the extent
  EXPECT_NO_THROW(start(held, constant(0.01, 0.)));
  DynamicSolver free(mesh, law, {}, {density, 0.}, {1e-3});
  EXPECT_THROW(free.start(Vector(), Vector()), InvalidInput);
  EXPECT_THROW(start(free, nullptr, constant(nan, 0.)), InvalidInput);
}

} // namespace dynamic_solver_test
