// Dynamics of sheets on one rank: orders in time, energy balance, units, and steps that do not converge.
#include "continuum/errors.h"
#include "moving_sheets.h"
#include "support/largest_error.h"

#include <gtest/gtest.h>

#include <algorithm>
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

std::unique_ptr<DynamicSolver> moved(const Mesh &mesh, const Problem &problem, const NewmarkParameters &rule,
                                     const unsigned int n_steps, const bool is_viscous = true)
{
  const DynamicSettings settings = quadratic(final_time / n_steps, rule);
  auto solver = std::make_unique<DynamicSolver>(mesh, Constitution(problem.law, problem.gradient), problem.conditions(),
                                                Inertia{density, 0.01}, settings,
                                                is_viscous ? &problem.viscosity : nullptr, Problem::load_factor);
  solver->start();
  solver->run_until(final_time);
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
      << coarse.ledger().imbalance << " " << ledger.imbalance << " of " << ledger.work;
    EXPECT_LT(std::abs(ledger.imbalance), 0.01 * ledger.work);
    EXPECT_GT(ledger.micro_kinetic, 0.01 * ledger.kinetic);
    EXPECT_LT(ledger.micro_kinetic, ledger.kinetic);
    EXPECT_EQ(ledger.dissipated > 0.05 * ledger.work, is_viscous);
    EXPECT_EQ(ledger.dissipated == 0., !is_viscous);
  };
  expect_second_order(*moved(mesh, problem, average_acceleration, 40), *half, true);
  for (const bool is_viscous : {true, false})
    expect_second_order(*moved(mesh, problem, generalised_alpha, 40, is_viscous),
                        *moved(mesh, problem, generalised_alpha, 80, is_viscous), is_viscous);
}

TEST(DynamicSolver, MovesHeldBoundariesWithTheLoadFactor)
{
  // u = sin(w t) H X is an exact motion of any sheet, all edges held, under the body force -rho w^2 H X sin(w t).
  const double w = 400.;
  const Tensor<2, 2> H = matrix(0.4, 0.2, -0.1, 0.3);
  BoundaryConditions conditions(on_all_edges(affine(identity + H)));
  conditions.body_force =
    BodyForce{std::make_shared<Field>([=](const Point<2> &X) { return -density * w * w * (H * Tensor<1, 2>(X)); })};
  RectangleMesh mesh(rectangle(2, 2));
  mesh.begin_active()->set_refine_flag(); // creates hanging nodes
  mesh.execute_coarsening_and_refinement();
  for (const NewmarkParameters &rule : {average_acceleration, generalised_alpha})
  {
    double before = 0.;
    for (const unsigned int n_steps : {50, 100})
    {
      const DynamicSettings settings = quadratic(2. / w / n_steps, rule);
      DynamicSolver solver(mesh, law, conditions, {density, 0.01}, settings, nullptr,
                           [w](const double t) { return std::sin(w * t); });
      const auto initial = std::make_shared<Field>([=](const Point<2> &X) { return w * (H * Tensor<1, 2>(X)); });
      solver.start(nullptr, initial);
      solver.run_until(2. / w);
      EXPECT_NEAR(solver.time(), 2. / w, 1e-12 / w);
      const double factor = std::sin(2.);
      double error = 0.;
      for (const auto &state : solver.evaluate(scattered_points(5, 5)))
        error =
          support::largest_of({error, (state.displacement - factor * (H * Tensor<1, 2>(state.X))).norm() / length});
      // Steps with w dt = 0.04 and 0.02: errors of the order of its square.
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

// Edges that are pulled apart within 1 ms and then held: held nodes stand still from the first step after the kink, and
// the energy balance closes. Newmark's formulas would let their velocity alternate between +10 and -10 m/s for ever.
TEST(DynamicSolver, StandsStillAfterARamp)
{
  const auto pull = affine(matrix(1., 0., 0., 1.2));
  for (const NewmarkParameters &rule : {average_acceleration, generalised_alpha})
  {
    std::vector<double> imbalance;
    for (const double dt : {1e-4, 2.5e-5})
    {
      RectangleMesh mesh(rectangle(8, 6));
      mesh.begin_active()->set_refine_flag(); // hanging nodes next to a held edge
      mesh.execute_coarsening_and_refinement();
      const DynamicSettings settings = quadratic(dt, rule);
      DynamicSolver solver(mesh, law, BoundaryConditions({{edge::bottom, pull}, {edge::top, pull}}), {density, 0.},
                           settings, nullptr, [](const double t) { return t < 1e-3 ? t / 1e-3 : 1.; });
      const auto fastest_held = [&](const Vector &rate)
      {
        double fastest = 0.;
        solver.sheet().for_each_owned_dof(
          [&](const auto dof, unsigned int, const Point<2> &X)
          {
            if (std::abs(X[1]) > 0.4999 * height)
              fastest = support::largest_of({fastest, std::abs(rate(dof))});
          });
        return fastest;
      };
      solver.start();
      solver.run_until(0.8e-3);
      // Half of a height of 0.1 m times 0.2 in 1 ms.
      EXPECT_NEAR(fastest_held(solver.velocity()), 10., 1e-9);
      solver.run_until(2.5e-3);
      EXPECT_LT(fastest_held(solver.velocity()), 1e-9);
      EXPECT_LT(fastest_held(solver.acceleration()), 1e-9 / dt);
      imbalance.push_back(std::abs(solver.ledger().imbalance) / solver.ledger().work);
    }
    // Of second order, as without a kink: a factor of 16 over two halvings of the step.
    EXPECT_LT(imbalance[1], 0.1 * imbalance[0]);
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
    solver.start(nullptr, std::make_shared<Field>(
                            [](const Point<2> &X) {
                              return Tensor<1, 2>({3. + 150. * X[0], -2. + 100. * X[1]});
                            }));
    const Tensor<1, 2> before = solver.momentum();
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
    EXPECT_NEAR((solver.momentum() - before).norm(), 0., impulse + 1e-13 * before.norm());
    EXPECT_EQ(solver.ledger().work, 0.);
  }
}

TEST(DynamicSolver, StartsWithTheAccelerationOfItsLoads)
{
  BoundaryConditions conditions;
  conditions.body_force = BodyForce{constant(3. * density, -2. * density)};
  RectangleMesh mesh(rectangle(2, 2));
  DynamicSolver solver(mesh, law, conditions, {density, 0.}, quadratic(1e-4));
  solver.start();
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
  solver.run_until(0.01);
  Vector difference = owned(solver.sheet(), solver.displacement());
  difference -= owned(equilibrium.sheet(), equilibrium.displacement());
  // Motion that the residual of the static solution, 1e-10 of the reactions, can cause.
  EXPECT_LT(difference.linfty_norm(), 1e-8 * length);
}

TEST(DynamicSolver, ThrowsWithHistoryAndStaysWhenAStepFails)
{
  // The right edge is pushed through the left one within one step.
  RectangleMesh mesh(rectangle(2, 2));
  DynamicSettings settings{1e-4};
  settings.degree = 1;
  DynamicSolver solver(mesh, law, on_all_edges(affine(matrix(0.5, 0., 0., 1.))), {density, 0.}, settings, nullptr,
                       [](const double t) { return t < 4.5e-4 ? 0. : 3.; });
  EXPECT_THROW(solver.step(), InvalidInput); // no start
  solver.start();
  Vector before = solver.sheet().make_ghosted();
  try
  {
    solver.run_until(1e-3, [&] { before = solver.displacement(); });
    FAIL() << "went on";
  }
  catch (const SolverFailed &failure)
  {
    // The whole step, its first half, and so on down to a sixteenth.
    ASSERT_GE(failure.report().load_steps.size(), 5u);
    EXPECT_FALSE(failure.report().load_steps.front().accepted);
    EXPECT_FALSE(failure.report().load_steps.back().accepted);
    EXPECT_EQ(failure.report().load_steps.back().number, 5u);
    EXPECT_NE(std::string(failure.what()).find("det F"), std::string::npos) << failure.what();
  }
  EXPECT_NEAR(solver.time(), 4e-4, 1e-15);
  EXPECT_EQ(solver.load_factor(), 0.);
  for (const auto i : solver.sheet().owned())
    EXPECT_EQ(solver.displacement()(i), before(i));
  EXPECT_EQ(solver.n_divided_steps(), 0u);

  // The largest of forces that are beyond all numbers, at the load that begins, is in a corner.
  BoundaryConditions loaded;
  loaded.body_force = BodyForce{std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0., X[0] > 0.8 * length && X[1] > 0.3 * height ? 1. : 0.});
    })};
  DynamicSolver beyond(mesh, law, loaded, {density, 0.}, settings, nullptr,
                       [](const double t) { return t > 0. ? 1e200 : 0.; });
  beyond.start();
  try
  {
    beyond.step();
    FAIL() << "went on";
  }
  catch (const SolverFailed &failure)
  {
    EXPECT_NE(std::string(failure.what()).find("not finite at X = (0.15, 0.05) m"), std::string::npos)
      << failure.what();
  }
}

// The right edge is pushed to the left by more than a cell within a step, slowly compared with waves: in the first
// iterate of a whole step the cells next to it are inverted, but not in those of smaller parts. Whole steps follow, and
// the energy balance over the parts closes.
TEST(DynamicSolver, DividesAStepThatCannotBeSolved)
{
  const double dt = 1e-2;
  const auto moved = [&](const unsigned int halvings)
  {
    RectangleMesh mesh(rectangle(8, 4));
    DynamicSettings settings = quadratic(dt);
    settings.max_step_halvings = halvings;
    DynamicSolver solver(mesh, law,
                         BoundaryConditions({{edge::left, affine(matrix(1., 0., 0., 1.))},
                                             {edge::right, affine(matrix(0.7, 0., 0., 1.))}}),
                         {density, 0.}, settings, nullptr,
                         [&](const double t) { return std::pow(std::sin(0.25 * pi * std::min(t / dt, 2.)), 2); });
    solver.start();
    solver.run_until(5. * dt);
    EXPECT_NEAR(solver.time(), 5. * dt, 1e-12 * dt);
    return std::tuple(solver.n_divided_steps(), solver.ledger(), solver.last_report().load_steps.size());
  };
  EXPECT_THROW(moved(0), SolverFailed);
  const auto [n_divided, ledger, attempts] = moved(4);
  EXPECT_GE(n_divided, 1u);
  EXPECT_LE(n_divided, 2u);
  EXPECT_EQ(attempts, 1u); // the last step is not divided
  // Second order in the step: 0.002 here. The work of one part is at least a tenth.
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
    solver.start(wave);
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

// Sheet with all quantities that have units: mass with micro-inertia, both laws, dashpots, a moving edge, a traction, a
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
                                             quadratic(t * 2e-4, generalised_alpha), &viscosity,
                                             [t](const double time) { return Problem::load_factor(time / t); });
    solver->start();
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

  // A held edge that is not at the prescribed position, fields with one component, a load factor that is not finite.
  DynamicSolver held(mesh, law, {{edge::left, constant(0.01, 0.)}}, {density, 0.}, {1e-3});
  EXPECT_THROW(held.start(), InvalidInput);
  EXPECT_THROW(held.start(constant(0.01 + 1e-8, 0.)), InvalidInput); // 6e-8 of the extent
  EXPECT_NO_THROW(held.start(constant(0.01, 0.)));
  DynamicSolver free(mesh, law, {}, {density, 0.}, {1e-3});
  EXPECT_THROW(free.start(std::make_shared<dealii::Functions::ZeroFunction<2>>(1)), InvalidInput);
  EXPECT_THROW(free.start(Vector(), Vector()), InvalidInput);
  DynamicSolver undefined(mesh, law, {}, {density, 0.}, {1e-3}, nullptr, [nan](double) { return nan; });
  EXPECT_THROW(undefined.start(), InvalidInput);
}

} // namespace dynamic_solver_test
