// Newton's method in the static solver on one rank: order, load steps, and failure to converge.
#include "continuum/errors.h"
#include "sheets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace static_newton_test
{

using namespace latcon;
using namespace sheets;
using continuum::StaticSettings;
using continuum::StaticSolver;
namespace edge = continuum::edge;

// Returns the residuals of the last load step.
std::vector<continuum::NewtonIteration> last_step(const continuum::SolverReport &report)
{
  std::vector<continuum::NewtonIteration> last;
  for (const auto &iteration : report.iterations)
    if (iteration.load_step == report.iterations.back().load_step)
      last.push_back(iteration);
  return last;
}

TEST(StaticSolver, NewtonIsQuadratic)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  RectangleMesh mesh(rectangle(12, 8));
  StaticSolver solver(mesh, law, bump_problem(2.3, 2.8, 0.03));
  const continuum::SolverReport report = solver.solve();
  EXPECT_EQ(report.load_steps.size(), 1u) << report.text();

  // Order q of r_(k+1) = C r_k^q from the first three residuals, between which the tangent is not kept.
  const std::vector<continuum::NewtonIteration> all = last_step(report);
  ASSERT_GE(all.size(), 3u) << report.text();
  EXPECT_GT(all[1].residual, 0.01 * all[0].residual);
  const double order = std::log(all[2].residual / all[1].residual) / std::log(all[1].residual / all[0].residual);
  EXPECT_GE(order, 1.8) << report.text();
  for (std::size_t k = 1; k < all.size(); ++k)
  {
    EXPECT_EQ(all[k].step_length, 1.);
    EXPECT_TRUE(k < 2 || all[k].residual <= 0.01 * all[k - 1].residual) << report.text();
  }
  EXPECT_LE(report.iterations.size(), 7u) << report.text();
}

TEST(StaticSolver, CutsALoadStepThatIsTooBig)
{
  // The bump pushes the top edge half way down: in a single step the predictor inverts cells.
  const continuum::MooneyRivlin law = rubber_sheet(0.1);
  RectangleMesh mesh(rectangle(12, 8));
  const auto conditions = bump_problem(1.2, 1.2, -0.07);
  StaticSolver at_once(mesh, law, conditions);
  const continuum::SolverReport report = at_once.solve();
  EXPECT_FALSE(report.load_steps.front().accepted) << report.text();
  EXPECT_FALSE(report.load_steps.front().reason.empty());
  EXPECT_TRUE(report.load_steps.back().accepted);
  EXPECT_EQ(report.load_factor, 1.);

  StaticSettings slowly;
  slowly.first_load_step = 1. / 64.;
  StaticSolver step_by_step(mesh, law, conditions, slowly);
  step_by_step.solve();
  // Residuals of 1e-10 of the reactions give an energy error of the order of their square: only round-off remains.
  EXPECT_NEAR(at_once.total_energy(), step_by_step.total_energy(), 1e-12 * step_by_step.total_energy());
}

TEST(StaticSolver, BacktracksOnEnergy)
{
  // Springs in compression soften, so a large compression needs steps shorter than full Newton steps.
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(12, 8));
  StaticSolver solver(mesh, law, bump_problem(1.1, 1.1, -0.045));
  const continuum::SolverReport report = solver.solve();
  double shortest = 1.;
  for (const auto &iteration : report.iterations)
    shortest = std::min(shortest, iteration.step_length);
  EXPECT_LT(shortest, 1.) << report.text();
  for (std::size_t k = 1; k < report.iterations.size(); ++k)
    if (report.iterations[k].iteration > 0)
    {
      EXPECT_LE(report.iterations[k].energy, report.iterations[k - 1].energy * (1. + 1e-13)) << report.text();
    }
  EXPECT_EQ(report.load_factor, 1.);
}

TEST(StaticSolver, ReportsEveryLoadStepToTheObserver)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(4, 4));
  StaticSettings settings;
  settings.first_load_step = 0.25;
  StaticSolver solver(mesh, law, on_all_edges(affine(matrix(2., 0., 0., 2.))), settings);
  std::vector<double> factors;
  solver.solve(
    [&](const double factor)
    {
      factors.push_back(factor);
      EXPECT_NEAR(solver.determinant_range().largest, (1. + factor) * (1. + factor), 1e-10);
    });
  // Each step converges fast and doubles the next.
  EXPECT_EQ(factors, (std::vector<double>{0.25, 0.75, 1.}));
}

TEST(StaticSolver, ThrowsWithHistoryWhenItDoesNotConverge)
{
  // The right edge is pushed through the left one, which no load step can reach.
  const continuum::MooneyRivlin law = rubber_sheet(0.1);
  RectangleMesh mesh(rectangle(6, 4));
  StaticSettings settings;
  settings.smallest_load_step = 1. / 16.;
  StaticSolver solver(mesh, law, on_all_edges(affine(matrix(-0.5, 0., 0., 1.))), settings);
  try
  {
    solver.solve();
    FAIL() << "converged";
  }
  catch (const continuum::SolverFailed &failure)
  {
    const auto &report = failure.report();
    EXPECT_FALSE(report.iterations.empty());
    EXPECT_FALSE(report.load_steps.back().accepted);
    EXPECT_GT(report.load_factor, 0.5);
    EXPECT_LT(report.load_factor, 2. / 3.); // where det F = 0
    EXPECT_EQ(report.load_factor, solver.load_factor());
    EXPECT_NE(std::string(failure.what()).find("residual"), std::string::npos);
    EXPECT_NE(std::string(failure.what()).find("det F"), std::string::npos);
  }
  EXPECT_GT(solver.determinant_range().smallest, 0.); // the last accepted state
}

TEST(StaticSolver, ThrowsWhenIterationsRunOut)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(6, 4));
  StaticSettings settings;
  settings.max_newton_iterations = 0;
  settings.smallest_load_step = 0.5;
  StaticSolver solver(mesh, law, bump_problem(2.3, 2.8, 0.03), settings);
  EXPECT_THROW(solver.solve(), continuum::SolverFailed);
  EXPECT_EQ(solver.load_factor(), 0.);
}

// theory-continuum.md, eq. (C.19).
TEST(StaticSolver, StopsAtTheRoundOffOfTheResidual)
{
  // With a tolerance below round-off, the floor ends the iteration, on coarse and fine meshes. The floor must be within
  // a factor of 100 of the residual reached, so it is not too large.
  const continuum::MooneyRivlin law = rubber_sheet();
  for (const unsigned int n : {4, 24})
  {
    RectangleMesh mesh(rectangle(n, n));
    StaticSettings settings;
    settings.relative_tolerance = 1e-30;
    StaticSolver solver(mesh, law, bump_problem(2.3, 2.8, 0.03), settings);
    const auto last = last_step(solver.solve()).back();
    EXPECT_LE(last.residual, last.tolerance);
    EXPECT_GE(last.residual, 0.01 * last.tolerance);
  }
}

} // namespace static_newton_test
