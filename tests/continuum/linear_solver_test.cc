// Reuse and rebuilding of multigrid, and unsymmetric matrices.
#include "continuum/element_integrals.h"
#include "continuum/errors.h"
#include "continuum/linear_solver.h"
#include "multigrid_cases.h"

#include <gtest/gtest.h>

namespace linear_solver_test
{

using namespace latcon;
using namespace multigrid_cases;
using continuum::LinearSettings;
using continuum::LinearSolver;
using continuum::Symmetry;

// Tangents at rest of a sheet for several internal lengths, with one solver.
struct Problem
{
  explicit Problem(LinearSettings settings, const Symmetry given_symmetry = Symmetry::symmetric)
    : mesh(rectangle(12, 8)), symmetry(given_symmetry)
  {
    sheet = std::make_unique<Sheet>(mesh, continuum::Constitution(law, gradient), 2, all_held());
    settings.direct_limit = 0;
    settings.coarsest_size = 100;
    solver = std::make_unique<LinearSolver>(*sheet, settings, symmetry);
    b = body_force(*sheet);
  }

  // Solves with the tangent for this length, compares with a direct solver, and returns the number of iterations.
  unsigned int solve(const double internal_length)
  {
    gradient = continuum::IsotropicGradient(5e5, internal_length);
    solver->update(sheet->make_ghosted(), assembler(), assemble_at_rest);
    Sheet::Vector x = sheet->make_owned();
    const unsigned int iterations = solver->solve(x, b);
    LinearSettings settings;
    settings.direct_limit = 1000000;
    LinearSolver direct(*sheet, settings);
    direct.update(sheet->make_ghosted(), assembler(), {});
    Sheet::Vector exact = sheet->make_owned();
    direct.solve(exact, b);
    x -= exact;
    // The residual is 1e-8 in the Euclidean norm; the smoothest waves dominate both x and b, so their error is
    // amplified no more than b.
    EXPECT_LT(x.l2_norm(), 1e-6 * exact.l2_norm());
    return iterations;
  }

  // Assembles the tangent. For an unsymmetric one, columns are scaled smoothly by 0.7 to 1.3, which multiplies it by a
  // matrix close to the identity, so that multigrid of the tangent is close to the inverse.
  continuum::Assembler assembler() const
  {
    Sheet::Vector scale = sheet->make_owned();
    sheet->for_each_owned_dof(
      [&](const auto dof, unsigned int, const Point<2> &X)
      {
        scale(dof) =
          1. + (symmetry == Symmetry::unsymmetric ? 0.3 : 0.) * std::sin(4. * X[0] / length + 3. * X[1] / height);
      });
    return [this, scale](const Sheet &, const Sheet::Vector &u, auto &K)
    {
      K = 0.;
      continuum::integrate(*sheet, u, continuum::energy_densities(*sheet, 1., continuum::Order::second),
                           continuum::Order::second,
                           [&](const continuum::Contribution &contribution)
                           {
                             dealii::FullMatrix<double> local = contribution.tangent;
                             for (unsigned int i = 0; i < local.m(); ++i)
                               for (unsigned int j = 0; j < local.n(); ++j)
                                 local(i, j) *= scale(contribution.dofs[j]);
                             sheet->homogeneous_constraints().distribute_local_to_global(local, contribution.dofs, K);
                           });
      K.compress(dealii::VectorOperation::add);
    };
  }

  const continuum::MooneyRivlin law = rubber_sheet();
  continuum::IsotropicGradient gradient{5e5, 0.01};
  RectangleMesh mesh;
  std::unique_ptr<Sheet> sheet;
  std::unique_ptr<LinearSolver> solver;
  Symmetry symmetry;
  Sheet::Vector b;
};

TEST(LinearSolver, KeepsAMultigridThatServes)
{
  Problem problem{LinearSettings()};
  const unsigned int fresh = problem.solve(0.05 * length);
  EXPECT_LE(problem.solve(0.052 * length), fresh + 2);
  problem.solve(0.049 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 1u);
  problem.solver->invalidate();
  problem.solve(0.049 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
}

TEST(LinearSolver, RenewsAMultigridThatIsWorn)
{
  Problem problem{LinearSettings()};
  problem.solve(0.02 * length);
  const unsigned int worn = problem.solve(0.2 * length); // a matrix a hundred times larger for short waves
  EXPECT_EQ(problem.solver->n_set_ups(), 1u);
  const unsigned int fresh = problem.solve(0.2 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
  EXPECT_LT(1.5 * fresh, worn);
  problem.solve(0.2 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);
}

// Rebuilds within one solve, if the old multigrid does not converge.
TEST(LinearSolver, RenewsAMultigridThatFails)
{
  LinearSettings settings;
  settings.max_iterations = 25;
  Problem problem(settings);
  problem.solve(0.02 * length);
  problem.solve(0.2 * length);
  EXPECT_EQ(problem.solver->n_set_ups(), 2u);

  settings.max_iterations = 3; // too few even for an up-to-date one
  Problem impossible(settings);
  EXPECT_THROW(impossible.solve(0.1 * length), continuum::LinearSolverFailed);
}

// GMRES, smoothed by the unsymmetric matrix itself, with coarser levels of the symmetric one.
TEST(LinearSolver, SolvesUnsymmetricMatrices)
{
  Problem symmetric{LinearSettings()};
  const unsigned int usual = symmetric.solve(0.05 * length);
  Problem unsymmetric(LinearSettings(), Symmetry::unsymmetric);
  // The eigenvalues have an additional spread of 1.3/0.7: at a rate of (sqrt(1.3) - sqrt(0.7))/(sqrt(1.3) + sqrt(0.7))
  // = 0.15 per iteration, eight digits take ten iterations.
  EXPECT_LE(unsymmetric.solve(0.05 * length), usual + 10);
  unsymmetric.solve(0.052 * length); // with the reused multigrid
  EXPECT_EQ(unsymmetric.solver->n_set_ups(), 1u);

  LinearSettings settings;
  settings.max_iterations = 3;
  Problem impossible(settings, Symmetry::unsymmetric);
  const std::string message = message_of<continuum::LinearSolverFailed>([&] { impossible.solve(0.1 * length); });
  EXPECT_NE(message.find("GMRES stopped after"), std::string::npos) << message;
}

// The factors are those of the last update, also after the first ones were freed.
TEST(LinearSolver, FactorisesAfterAnUpdate)
{
  const Problem problem{LinearSettings()};
  LinearSettings settings;
  settings.direct_limit = 1000000;
  LinearSolver direct(*problem.sheet, settings);
  const auto updated = [&](const double factor)
  {
    direct.update(problem.sheet->make_ghosted(),
                  [&](const Sheet &sheet, const Sheet::Vector &u, auto &K)
                  {
                    assemble_at_rest(sheet, u, K);
                    K *= factor;
                  },
                  {});
    Sheet::Vector x = problem.sheet->make_owned();
    direct.solve(x, problem.b);
    return x;
  };
  const auto i = *problem.sheet->owned().begin();
  EXPECT_EQ(direct.diag_element(i), 0.);
  const Sheet::Vector first = updated(1.);
  const double diagonal = direct.diag_element(i);
  EXPECT_GT(diagonal, 0.);
  for (const bool frees : {false, true})
  {
    if (frees)
      direct.release();
    EXPECT_EQ(direct.diag_element(i), frees ? 0. : diagonal);
    Sheet::Vector second = updated(2.);
    EXPECT_EQ(direct.diag_element(i), 2. * diagonal);
    second *= 2.;
    second -= first;
    EXPECT_LT(second.l2_norm(), 1e-10 * first.l2_norm());
    EXPECT_EQ(updated(1.), first);
  }
}

} // namespace linear_solver_test
