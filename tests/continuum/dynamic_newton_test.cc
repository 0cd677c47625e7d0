// Newton's method of a time step on one rank.
#include "continuum/newton_solver.h"
#include "moving_sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dynamic_newton_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::Constitution;
using continuum::DynamicSettings;
using continuum::DynamicSolver;
using continuum::FibreViscosity;
using continuum::NewmarkParameters;
using Vector = continuum::Sheet::Vector;

TEST(DynamicSolver, NewtonIsQuadraticWithViscosityAtFiniteStrain)
{
  RectangleMesh mesh(rectangle(4, 4));
  const Problem problem;
  DynamicSettings settings{2e-3}; // long, so that the predictor is poor
  settings.degree = 2;
  settings.rule = NewmarkParameters::generalised_alpha(0.7);
  const FibreViscosity viscosity = network_viscosity(200., 0.01);
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
    settings.linear.multigrid.coarsest_size = 100;
    DynamicSolver solver(mesh, Constitution(problem.law, problem.gradient), problem.conditions(), {density, 0.01},
                         settings, &viscosity, Problem::load_factor);
    solver.start();
    unsigned int newton = 0, most_linear = 0;
    for (int n = 0; n < 6; ++n)
    {
      solver.step();
      for (const auto &iteration : solver.last_report().iterations)
      {
        newton += 1;
        most_linear = std::max(most_linear, iteration.linear_iterations);
      }
    }
    continuum::Sheet::Vector u = solver.sheet().make_owned();
    u = solver.displacement();
    return std::make_tuple(u, solver.ledger(), newton, most_linear);
  };
  const auto [exact, exact_ledger, newton, none] = moved(1000000);
  const auto [u, ledger, newton_of_gmres, most_linear] = moved(0);
  EXPECT_EQ(none, 0u);
  EXPECT_GT(most_linear, 2u);
  EXPECT_LE(most_linear, 30u);
  EXPECT_LE(newton_of_gmres, newton + 6); // linear systems are solved to 1e-8 instead of round-off
  // Each step converges to 1e-10 of the acting forces; waves as long as the sheet, which dominate u, are amplified no
  // more than the forces.
  continuum::Sheet::Vector difference = u;
  difference -= exact;
  EXPECT_LT(difference.l2_norm(), 1e-8 * exact.l2_norm());
  EXPECT_NEAR(ledger.dissipated, exact_ledger.dissipated, 1e-8 * exact_ledger.dissipated);
  EXPECT_GT(ledger.dissipated, 0.1 * ledger.stored);
}

// Whole Newton steps for arctan u = 0 diverge from |u| > 1.39; with a line search they converge.
TEST(NewtonSolver, ReducesTheResidualWithoutAnEnergy)
{
  struct State
  {
    double free, reference, energy;
  };
  dealii::IndexSet one(1);
  one.add_index(0);
  Vector u(one, MPI_COMM_SELF);
  u(0) = 3.;
  u.compress(dealii::VectorOperation::insert);
  const auto evaluate = [](const Vector &at) { return State{std::abs(std::atan(at(0))), 1., 0.}; };
  std::vector<bool> keeps;
  double tangent_at = 0.;
  const continuum::NewtonSolver<State> newton(
    {1e-12, 20, 10}, {evaluate, [](const State &, const Vector &) { return 0.; },
                      [&](const State &, const Vector &at, double, const bool keeps_tangent, Vector &step)
                      {
                        keeps.push_back(keeps_tangent);
                        if (!keeps_tangent)
                          tangent_at = at(0);
                        step(0) = -std::atan(at(0)) * (1. + tangent_at * tangent_at);
                        step.compress(dealii::VectorOperation::insert);
                        return continuum::NewtonStep{0, 0.};
                      },
                      nullptr, nullptr});
  std::vector<continuum::NewtonIteration> history;
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

} // namespace dynamic_newton_test
