// Newton's method of a time step on one rank.
#include "continuum/newton_solver.h"
#include "moving_sheets.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dynamic_newton_test
{

using namespace moving_sheets;
using namespace latcon::continuum;
using Vector = Sheet::Vector;

// Order of the last three residuals above the round-off of their tolerance; 0 if there are fewer.
double last_order(const std::vector<NewtonIteration> &iterations)
{
  std::size_t n = 0;
  while (n < iterations.size() && (n == 0 || iterations[n - 1].residual > 1e3 * iterations[n - 1].tolerance))
    ++n;
  return n < 3 ? 0. : newton_order(iterations, n - 3);
}

TEST(DynamicSolver, NewtonIsQuadraticWithViscosityAtFiniteStrain)
{
  RectangleMesh mesh(rectangle(4, 4));
  const Problem problem;
  const FibreViscosity viscosity = network_viscosity(200., 0.01);
  // Long steps, so that the predictor is poor.
  DynamicSolver solver(mesh, Constitution(problem.law, problem.gradient), problem.conditions(), {density, 0.01},
                       quadratic(2e-3, NewmarkParameters::generalised_alpha(0.6)), &viscosity);
  start(solver);
  double best = 0.;
  for (int n = 0; n < 4; ++n)
  {
    solver.step();
    best = std::max(best, last_order(solver.last_report().iterations));
    EXPECT_LE(solver.last_report().iterations.size(), 8u) << solver.last_report().text();
  }
  EXPECT_GE(best, 1.7) << solver.last_report().text();
}

// Unsymmetric matrix of dashpots at finite strain, solved by GMRES with multigrid of its symmetric part.
TEST(DynamicSolver, GmresAgreesWithTheDirectSolver)
{
  const Problem problem;
  const FibreViscosity viscosity = network_viscosity(200., 0.01);
  const auto moved = [&](const dealii::types::global_dof_index direct_limit)
  {
    RectangleMesh mesh(rectangle(8, 8));
    DynamicSettings settings = quadratic(5e-4);
    settings.linear.direct_limit = direct_limit;
    settings.linear.coarsest_size = 100;
    DynamicSolver solver(mesh, Constitution(problem.law, problem.gradient), problem.held(), {density, 0.01}, settings,
                         &viscosity);
    start(solver, nullptr, Problem::velocity());
    std::size_t newton = 0;
    unsigned int most_linear = 0;
    for (int n = 0; n < 6; ++n)
    {
      solver.step();
      newton += solver.last_report().iterations.size();
      most_linear = std::max(most_linear, most_linear_iterations(solver.last_report()));
    }
    return std::make_tuple(owned(solver.sheet(), solver.displacement()), solver.ledger(), newton, most_linear);
  };
  const auto [exact, exact_ledger, newton, none] = moved(1000000);
  const auto [u, ledger, newton_of_gmres, most_linear] = moved(0);
  EXPECT_EQ(none, 0u);
  EXPECT_GT(most_linear, 2u);
  EXPECT_LE(most_linear, 30u);
  EXPECT_LE(newton_of_gmres, newton + 6); // linear systems are solved to 1e-8 instead of round-off
  // Each step converges to 1e-10 of the acting forces; waves as long as the sheet, which dominate u, are amplified no
  // more than the forces.
  Vector difference = u;
  difference -= exact;
  EXPECT_LT(difference.l2_norm(), 1e-8 * exact.l2_norm());
  EXPECT_NEAR(ledger.dissipated, exact_ledger.dissipated, 1e-8 * exact_ledger.dissipated);
  EXPECT_GT(ledger.dissipated, 0.1 * ledger.stored);
}

struct State
{
  double free, reference, energy;
};

Vector one_unknown(const double value)
{
  dealii::IndexSet one(1);
  one.add_index(0);
  Vector u(one, MPI_COMM_SELF);
  u = value;
  return u;
}

// Whole Newton steps for arctan u = 0 diverge from |u| > 1.39; with a line search they converge.
TEST(NewtonSolver, ReducesTheResidualWithoutAnEnergy)
{
  Vector u = one_unknown(3.);
  const auto evaluate = [](const Vector &at) { return State{std::abs(std::atan(at(0))), 1., 0.}; };
  std::vector<bool> keeps;
  double tangent_at = 0.;
  const NewtonSolver<State> newton{{1e-12, 20},
                                   {evaluate, [](const State &, const Vector &) { return 0.; },
                                    [&](const State &, const Vector &at, double, const bool keeps_tangent, Vector &step)
                                    {
                                      keeps.push_back(keeps_tangent);
                                      if (!keeps_tangent)
                                        tangent_at = at(0);
                                      step(0) = -std::atan(at(0)) * (1. + tangent_at * tangent_at);
                                      step.compress(dealii::VectorOperation::insert);
                                      return NewtonStep{0, 0.};
                                    },
                                    nullptr, nullptr}};
  std::vector<NewtonIteration> history;
  State state = evaluate(u);
  EXPECT_EQ(newton.solve(u, state, 1, 1., 0, history), "");
  EXPECT_LT(std::abs(u(0)), 1e-12);
  EXPECT_EQ(state.free, std::abs(std::atan(u(0))));
  // A tangent is kept while the residual falls a hundredfold.
  ASSERT_EQ(keeps.size() + 1, history.size());
  EXPECT_FALSE(keeps[0]);
  EXPECT_TRUE(keeps.back());
  for (std::size_t i = 1; i < history.size(); ++i)
  {
    EXPECT_LT(history[i].residual, history[i - 1].residual);
    EXPECT_TRUE(i == keeps.size() || keeps[i] == (history[i].residual <= 0.01 * history[i - 1].residual));
  }
}

// Given states in place of an equation, with a slope of -1, a noise of 0.1 and a tolerance of 1e-6.
TEST(NewtonSolver, AcceptsStepsAndAsksForForcingByItsRules)
{
  std::vector<State> given{{0.0101, 1., 0.09991},                  // the energy may rise by 0.1 - 1e-4
                           {0.9, 1., 0.09996},                     // half a step: by 0.1 - 5e-5
                           {0.5, 1., 0.09997},                     // a quarter: accepted
                           {0.1, 1., 0.},         {1e-3, 1., 7.},  // a residual a hundredfold smaller, at any energy
                           {2e-5, 1., 0.},        {1e-6, 1., 9.}}; // within the tolerance, at any energy
  auto next = given.begin();
  std::vector<double> forcings, lengths;
  double slope = -1.;
  const NewtonSolver<State> newton{{1e-6, 20, 0.6},
                                   {[&](const Vector &) { return *next++; },
                                    [](const State &, const Vector &) { return 0.; },
                                    [&](const State &, const Vector &, const double forcing, bool, Vector &)
                                    {
                                      forcings.push_back(forcing);
                                      return NewtonStep{0, slope};
                                    },
                                    [](const State &) { return 0.1; }, nullptr}};
  std::vector<NewtonIteration> history;
  Vector u = one_unknown(0.);
  State state{1., 1., 0.};
  EXPECT_EQ(newton.solve(u, state, 1, 1., 0, history), "");
  EXPECT_EQ(next, given.end());
  for (const NewtonIteration &iteration : history)
    lengths.push_back(iteration.step_length);
  EXPECT_EQ(lengths, (std::vector<double>{1., 0.25, 1., 1., 1., 1.}));
  // 0.9 times the squared reduction of the residual, at most 0.6; where less than a hundred tolerances are left for
  // that, a tenth of the tolerance.
  const std::vector<double> expected{0.6, 0.9 * 0.25, 0.9 * 0.04, 1e-4, 5e-3};
  ASSERT_EQ(forcings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(forcings[i], expected[i], 1e-12);

  for (const double not_downhill : {0., std::nan("")})
  {
    slope = not_downhill;
    state.free = 1.;
    EXPECT_EQ(newton.solve(u, state, 1, 1., 0, history), "the tangent is not positive definite along the Newton step");
  }
}

} // namespace dynamic_newton_test
