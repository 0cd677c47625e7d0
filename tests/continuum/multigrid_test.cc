#include "continuum/element_integrals.h"
#include "continuum/errors.h"
#include "continuum/vertex_patches.h"
#include "multigrid_cases.h"

#include <gtest/gtest.h>

namespace multigrid_test
{

using namespace latcon;
using namespace multigrid_cases;

// On a mesh of 3 x 2 cells, halved `halvings` times and then refined `times` times around an interior point; every one
// here has several levels.
struct LinearProblem : HeldSheet
{
  LinearProblem(const double internal_length, const unsigned int degree, const unsigned int halvings,
                const unsigned int times, const dealii::types::global_dof_index coarsest_size = 300)
    : HeldSheet(internal_length, degree, rectangle(3u << halvings, 2u << halvings), times, coarsest_size)
  {
  }

  // Returns the number of iterations to a residual of 1e-8.
  unsigned int iterations() const
  {
    Sheet::Vector x = sheet->make_owned();
    const Sheet::Vector b = body_force(*sheet);
    EXPECT_GT(b.l2_norm(), 0.); // otherwise nothing is to be iterated
    return solve(*multigrid, K, x, b);
  }

  // Returns random numbers at the free degrees of freedom.
  Multigrid::Vector random(const unsigned int seed) const
  {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> number(-1., 1.);
    Multigrid::Vector v;
    multigrid->initialize(v);
    for (const auto i : sheet->owned())
      v(i) = sheet->homogeneous_constraints().is_constrained(i) ? 0. : number(generator);
    return v;
  }
};

TEST(Multigrid, IsSymmetricAndPositive)
{
  for (const unsigned int degree : {1u, 2u, 3u})
    for (const double internal_length : {0., 0.1 * length})
    {
      if (degree == 1 && internal_length > 0.)
        continue;
      const LinearProblem problem(internal_length, degree, 2, 3);
      const auto a = problem.random(1);
      const auto b = problem.random(2);
      auto Ba = a;
      auto Bb = b;
      problem.multigrid->vmult(Ba, a);
      problem.multigrid->vmult(Bb, b);
      EXPECT_NEAR(Ba * b, a * Bb, 1e-11 * Ba.l2_norm() * b.l2_norm());
      EXPECT_GT(Ba * a, 0.);
      EXPECT_GT(Bb * b, 0.);
    }
}

// Measured here: up to 7 of the local law; with internal lengths of 0.01 and 0.1 up to 13 and 18 of degree 2, 9 and 10
// of degree 3.
TEST(Multigrid, NeedsAboutAsManyIterationsOnEveryMesh)
{
  struct Case
  {
    double relative_length;
    unsigned int degree, limit;
  };
  for (const auto &[relative_length, degree, limit] :
       {Case{0., 2, 7}, Case{0., 3, 7}, Case{0.01, 2, 14}, Case{0.01, 3, 10}, Case{0.1, 2, 19}, Case{0.1, 3, 11}})
  {
    std::vector<std::pair<unsigned int, unsigned int>> meshes{{2, 0}, {2, 4}, {3, 0}};
    if (degree == 2 && relative_length > 0.05) // which needs the most
      meshes.emplace_back(4, 0);
    for (const auto &[halvings, times] : meshes)
      EXPECT_LE(LinearProblem(relative_length * length, degree, halvings, times).iterations(), limit)
        << "length " << relative_length << ", degree " << degree << ", " << halvings << " halvings, refined " << times
        << " times";
  }
}

// Rayleigh quotient of K after some steps of the power method with patches times K.
double largest_eigenvalue(const LinearProblem &problem)
{
  continuum::VertexPatches patches(*problem.sheet, problem.sheet->homogeneous_constraints());
  patches.factorise(problem.K);
  Multigrid::Vector v = problem.random(1), Kv(v), next(v);
  double eigenvalue = 0.;
  for (unsigned int step = 0; step < 60; ++step)
  {
    problem.K.vmult(Kv, v);
    patches.vmult(next, Kv);
    eigenvalue = (next * Kv) / (v * Kv);
    v.equ(1. / next.l2_norm(), next);
  }
  return eigenvalue;
}

// The smoother relies on the bound 6, around hanging nodes as elsewhere, and on 4 without faces.
TEST(Multigrid, HasPatchesWithBoundedEigenvalues)
{
  for (const unsigned int degree : {2u, 3u})
    for (const unsigned int times : {0u, 4u})
    {
      const double with_faces = largest_eigenvalue(LinearProblem(0.1 * length, degree, 2, times));
      EXPECT_GT(with_faces, 4.5);
      EXPECT_LT(with_faces, 6.);
      const double cells_alone = largest_eigenvalue(LinearProblem(0., degree, 2, times));
      EXPECT_GT(cells_alone, 3.9);
      EXPECT_LT(cells_alone, 4. + 1e-5); // inverses in single precision
    }
}

TEST(Multigrid, HasAPatchForEveryFreeDegreeOfFreedom)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  for (const unsigned int degree : {1u, 2u, 3u})
  {
    // Randomly refined cells, with all combinations of levels that a mesh can have.
    RectangleMesh mesh(rectangle(6, 4));
    std::mt19937 generator(degree);
    for (unsigned int n = 0; n < 4; ++n)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        if (generator() % 3 == 0)
          cell->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
    }
    const Sheet sheet(mesh, law, degree, left_held_across());
    const AffineConstraints<double> &constraints = sheet.homogeneous_constraints();
    // A diagonal matrix.
    SinglePrecisionMatrix K;
    K.reinit(sheet, constraints);
    continuum::integrate(sheet, sheet.make_ghosted(), continuum::energy_densities(sheet, 1., continuum::Order::value),
                         continuum::Order::value,
                         [&](const continuum::Contribution &contribution)
                         {
                           dealii::FullMatrix<double> diagonal(contribution.dofs.size());
                           for (unsigned int a = 0; a < contribution.dofs.size(); ++a)
                             diagonal(a, a) = constraints.is_constrained(contribution.dofs[a]) ? 0. : 1.;
                           constraints.distribute_local_to_global(diagonal, contribution.dofs, K);
                         });

    // Each patch adds the inverse of the diagonal.
    continuum::VertexPatches patches(sheet, constraints);
    patches.factorise(K);
    Multigrid::Vector ones(patches.layout());
    Multigrid::Vector inverses(patches.layout());
    ones = 1.;
    patches.vmult(inverses, ones);
    for (const auto i : sheet.owned())
    {
      if (constraints.is_constrained(i))
        EXPECT_EQ(inverses(i), 0.);
      else
        EXPECT_GE(inverses(i) * K.diag_element(i), 1. - 1e-6); // in single precision
    }
  }
}

TEST(Multigrid, IsADirectSolverOnAMeshThatIsCoarseEnough)
{
  const LinearProblem problem(0.01 * length, 2, 2, 1, 1000000);
  EXPECT_LE(problem.iterations(), 2u);
}

Tensor<1, 2> quadratic(const Point<2> &X)
{
  return Tensor<1, 2>({0.4 * X[0] - 2. * X[0] * X[1], 0.2 * X[1] + 3. * X[0] * X[0] - X[1] * X[1]});
}

TEST(Multigrid, TakesTheStateToEveryLevel)
{
  // A quadratic field, including held boundaries, is represented exactly on every mesh.
  for (const unsigned int degree : {2u, 3u})
  {
    const LinearProblem problem(0., degree, 2, 3);
    unsigned int n_levels = 1;
    problem.multigrid->update(nodal(*problem.sheet, quadratic),
                              [&](const Sheet &level, const Sheet::Vector &u, auto &K)
                              {
                                Sheet::Vector difference = owned(level, u);
                                const Sheet::Vector exact = owned(level, nodal(level, quadratic));
                                difference -= exact;
                                EXPECT_LT(difference.linfty_norm(), 1e-13 * exact.linfty_norm()) << "degree " << degree;
                                assemble_at_rest(level, u, K);
                                ++n_levels;
                              });
    EXPECT_GE(n_levels, 4u);
  }
}

TEST(Multigrid, TakesAPartOfAStateThatACoarserLevelCannotHave)
{
  const LinearProblem problem(0., 2, 3, 0);
  const Sheet::Vector u = nodal(*problem.sheet, quadratic);
  double taken = 1.; // on the coarsest level
  const auto update = [&](const double refused)
  {
    problem.multigrid->update(u,
                              [&](const Sheet &level, const Sheet::Vector &state, auto &K)
                              {
                                taken = state.linfty_norm() / u.linfty_norm();
                                if (taken >= refused)
                                  throw continuum::NonPhysicalState("too large");
                                assemble_at_rest(level, state, K);
                              });
  };
  update(0.3);
  EXPECT_DOUBLE_EQ(taken, 0.25);
  EXPECT_LE(problem.iterations(), 8u);
  update(1e-3);
  EXPECT_EQ(taken, 0.);
  EXPECT_LE(problem.iterations(), 8u);
  EXPECT_THROW(update(0.), continuum::NonPhysicalState);
}

TEST(Multigrid, StaysFiniteForATangentThatIsNotPositiveDefinite)
{
  LinearProblem problem(0., 2, 3, 1);
  problem.K *= -1.;
  problem.multigrid->set_finest(problem.K);
  // Blocks are replaced by a diagonal.
  const AffineConstraints<double> &constraints = problem.sheet->homogeneous_constraints();
  continuum::VertexPatches patches(*problem.sheet, constraints);
  patches.factorise(problem.K);
  const auto &owned = problem.sheet->owned();
  const auto free =
    *std::find_if_not(owned.begin(), owned.end(), [&](auto i) { return constraints.is_constrained(i); });
  Multigrid::Vector one(patches.layout()), z(one);
  one(free) = 1.;
  patches.vmult(z, one);
  EXPECT_GT(z(free), 0.);
  EXPECT_EQ(z.l1_norm(), z(free));
  const auto r = problem.random(4);
  problem.multigrid->vmult(z, r);
  EXPECT_TRUE(std::isfinite(z.l2_norm()));
}

} // namespace multigrid_test
