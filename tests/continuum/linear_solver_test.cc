// When a multigrid is kept and when it is set up anew.
#include "continuum/errors.h"
#include "continuum/linear_solver.h"
#include "multigrid_cases.h"

#include <gtest/gtest.h>

using namespace multigrid_cases;
using continuum::LinearSettings;
using continuum::LinearSolver;

namespace
{
// Matrices of one sheet for several internal lengths, by one solver.
struct Problem
{
  explicit Problem(LinearSettings settings) : law(rubber_sheet()), mesh(MPI_COMM_SELF)
  {
    continuum::make_rectangle(mesh, rectangle(24, 16));
    sheet = std::make_unique<Sheet>(mesh, continuum::Constitution(law, gradient), 2);
    constraints = std::make_unique<AffineConstraints<double>>();
    constraints->copy_from(continuum::homogeneous_constraints(*sheet, all_held()));
    settings.direct_limit = 0;
    settings.multigrid.coarsest_size = 300;
    solver = std::make_unique<LinearSolver>(*sheet, all_held(), settings);
    sheet->make_matrix(*constraints, K);
    b = sheet->make_owned();
    body_force(*sheet, *constraints, b);
  }

  // Iterations for the form with this length; expects the answer of a direct solver.
  unsigned int solve(const double internal_length)
  {
    const GradientForm form(internal_length);
    form.assemble(*sheet, *constraints, K);
    solver->update(sheet->make_ghosted(), K, form.assembler());
    Sheet::Vector x = sheet->make_owned();
    const unsigned int iterations = solver->solve(K, x, b);
    LinearSettings direct;
    direct.direct_limit = 1000000;
    Sheet::Vector exact = sheet->make_owned();
    LinearSolver(*sheet, all_held(), direct).solve(K, exact, b);
    x -= exact;
    // The residual is 1e-8 in the Euclidean norm; the smoothest waves, which make up x, are amplified by no more than
    // those of b, which they make up too.
    EXPECT_LT(x.l2_norm(), 1e-6 * exact.l2_norm());
    return iterations;
  }

  continuum::MooneyRivlin law;
  continuum::IsotropicGradient gradient{5e5, 0.01};
  Mesh mesh;
  std::unique_ptr<Sheet> sheet;
  std::unique_ptr<AffineConstraints<double>> constraints;
  std::unique_ptr<LinearSolver> solver;
  Sheet::Matrix K;
  Sheet::Vector b;
};
} // namespace

TEST(LinearSolver, KeepsAMultigridThatServes)
{
  Problem problem{LinearSettings()};
  const unsigned int fresh = problem.solve(0.05 * length);
  EXPECT_LE(problem.solve(0.052 * length), fresh + 2);
  problem.solve(0.049 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 1u);
  problem.solver->forget();
  problem.solve(0.049 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
}

TEST(LinearSolver, RenewsAMultigridThatIsWorn)
{
  Problem problem{LinearSettings()};
  problem.solve(0.02 * length);
  const unsigned int worn = problem.solve(0.08 * length); // a matrix sixteen times as large for short waves
  EXPECT_EQ(problem.solver->n_set_ups(), 1u);
  const unsigned int fresh = problem.solve(0.08 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
  EXPECT_LT(1.5 * fresh, worn);
  problem.solve(0.08 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
}

// Within one solve, where the old one does not get there.
TEST(LinearSolver, RenewsAMultigridThatFails)
{
  LinearSettings settings;
  settings.max_iterations = 25;
  Problem problem(settings);
  problem.solve(0.02 * length);
  problem.solve(0.2 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);

  settings.max_iterations = 3; // too few for a fresh one
  Problem impossible(settings);
  EXPECT_THROW(impossible.solve(0.1 * length), continuum::LinearSolverFailed);
}

TEST(LinearSolver, RefusesSettingsOutOfRange)
{
  for (const double limit : {-1., std::nan("")})
  {
    LinearSettings settings;
    settings.wear_limit = limit;
    EXPECT_THROW(Problem{settings}, continuum::InvalidInput);
  }
}
