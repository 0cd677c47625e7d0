// Static solver on one rank: exactness, reactions, linear solvers, and refusals.
//
//            top: held             Every edge is held unless a test says otherwise. The bump problem is smooth up to
//        +--------------+          the corners, so that the orders of the elements can show.
//   left |    sheet     | right
//        +--------------+
//             bottom
#include "continuum/errors.h"
#include "sheets.h"

#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <cmath>

namespace static_solver_test
{

using namespace latcon;
using namespace sheets;
using continuum::StaticSettings;
using continuum::StaticSolver;
namespace edge = continuum::edge;

// Moves interior vertices by up to 0.3 of a cell; vertices on the edges do not move.
void distort(Mesh &mesh, const unsigned int cells_x, const unsigned int cells_y)
{
  dealii::GridTools::transform(
    [=](const Point<2> &X)
    {
      const double inside = std::sin(pi * X[0] / length) * std::cos(pi * X[1] / height); // zero on the edges, at most 1
      return X + 0.3 * inside *
                   Point<2>(length / cells_x * std::cos(700. * X[1]), height / cells_y * std::sin(500. * X[0]));
    },
    mesh);
}

TEST(StaticSolver, PassesPatchTestOnDistortedMesh)
{
  const Tensor<2, 2> F = matrix(2.3, 0.25, -0.1, 1.4);
  const continuum::CauchyBorn network = rubber_network();
  const continuum::MooneyRivlin sheet = rubber_sheet();
  for (const continuum::Material *law :
       {static_cast<const continuum::Material *>(&network), static_cast<const continuum::Material *>(&sheet)})
    for (const unsigned int degree : {1, 2, 3})
    {
      RectangleMesh mesh(rectangle(6, 4));
      distort(mesh, 6, 4);
      StaticSettings settings;
      settings.degree = degree;
      settings.relative_tolerance = 1e-12;
      StaticSolver solver(mesh, *law, on_all_edges(affine(F)), settings);
      solver.solve();

      const double W = law->energy(F);
      const Tensor<2, 2> P = law->first_piola_stress(F);
      for (const auto &state : solver.evaluate(scattered_points()))
      {
        EXPECT_NEAR((state.displacement - (F * Tensor<1, 2>(state.X) - Tensor<1, 2>(state.X))).norm(), 0.,
                    1e-10 * length);
        EXPECT_NEAR((state.F - F).norm(), 0., 1e-10);
        EXPECT_NEAR((state.P - P).norm(), 0., 1e-10 * law->tangent(F).norm());
        EXPECT_NEAR(state.energy_density, W, 1e-10 * W);
      }
      EXPECT_NEAR(solver.total_energy(), W * length * height, 1e-10 * W * length * height);
      EXPECT_NEAR(solver.determinant_range().smallest, determinant(F), 1e-10);
      EXPECT_NEAR(solver.determinant_range().largest, determinant(F), 1e-10);

      // Reactions are P N times the reference length of the edge.
      const auto reactions = solver.reactions();
      const double force = P.norm() * length;
      EXPECT_NEAR((reactions.at(edge::right) - height * P * Tensor<1, 2>({1., 0.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::left) + height * P * Tensor<1, 2>({1., 0.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::top) - length * P * Tensor<1, 2>({0., 1.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::bottom) + length * P * Tensor<1, 2>({0., 1.})).norm(), 0., 1e-10 * force);
    }
}

TEST(StaticSolver, HoldsOnlyTheMaskedComponents)
{
  // Uniaxial tension: u_x is prescribed left and right, u_y at the bottom, the top is free.
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(3, 2));
  const auto pulled = std::make_shared<Field>([](const Point<2> &X) { return Tensor<1, 2>({X[0], 1.}); });
  const auto still = std::make_shared<Field>([](const Point<2> &) { return Tensor<1, 2>({5., 0.}); });
  const dealii::ComponentMask x(std::vector<bool>{true, false});
  const dealii::ComponentMask y(std::vector<bool>{false, true});
  StaticSettings settings;
  settings.relative_tolerance = 1e-12;
  StaticSolver solver(mesh, law, {{edge::left, pulled, x}, {edge::right, pulled, x}, {edge::bottom, still, y}},
                      settings);
  solver.solve();

  // The lateral stretch, found here by bisection of P_22(diag(2, s)) = 0.
  double low = 0.4;
  double high = 1.;
  while (high - low > 1e-15)
  {
    const double middle = 0.5 * (low + high);
    (law.first_piola_stress(matrix(2., 0., 0., middle))[1][1] > 0. ? high : low) = middle;
  }
  const auto state = solver.evaluate({Point<2>(0.31 * length, 0.17 * height)}).front();
  EXPECT_NEAR((state.F - matrix(2., 0., 0., low)).norm(), 0., 1e-10);
  EXPECT_NEAR(solver.reactions().at(edge::right)[0], state.P[0][0] * height, 1e-10 * state.P[0][0] * height);
  EXPECT_NEAR(solver.reactions().at(edge::right)[1], 0., 1e-10 * state.P[0][0] * height);
}

// theory-continuum.md, eqs. (C.16) and (C.17).
TEST(StaticSolver, ReactionsBalance)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  RectangleMesh mesh(rectangle(12, 8));
  StaticSolver solver(mesh, law, bump_problem(2.3, 2.8, 0.03));
  solver.solve();
  Tensor<1, 2> sum;
  double size = 0.;
  for (const auto &[boundary, force] : solver.reactions())
  {
    sum += force;
    size += force.norm();
  }
  // Free residuals are at most 1e-10 of the reactions, and the sum is off by these residuals.
  EXPECT_NEAR(sum.norm(), 0., 1e-10 * size);
}

// theory-continuum.md, eqs. (C.15) and (C.18).
TEST(StaticSolver, ReactionIsTheDerivativeOfTheEnergy)
{
  // dE/d(load factor) = reaction of the top edge times its unit displacement, with all other edges fixed.
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(8, 8));
  const auto energy_and_reaction = [&](const double lift)
  {
    const auto raised = std::make_shared<Field>(
      [lift](const Point<2> &X) {
        return Tensor<1, 2>({0.4 * X[0], (X[1] > 0. ? lift : 0.)});
      });
    const auto sides = dealii::ComponentMask(std::vector<bool>{true, false});
    StaticSolver solver(mesh, law, {{edge::top, raised}, {edge::bottom, raised}, {edge::left, raised, sides}});
    solver.solve();
    return std::make_pair(solver.total_energy(), solver.reactions().at(edge::top)[1]);
  };
  const double lift = 0.05;
  const double h = 1e-4 * lift;
  const double slope = (energy_and_reaction(lift + h).first - energy_and_reaction(lift - h).first) / (2. * h);
  // Central difference: relative truncation of the order of (h/lift)^2 = 1e-8, round-off of 1e-16/1e-4 = 1e-12.
  EXPECT_NEAR(energy_and_reaction(lift).second, slope, 1e-7 * slope);
}

TEST(StaticSolver, ConjugateGradientsAgreeWithDirectSolver)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  std::vector<unsigned int> most_iterations;
  for (const unsigned int n : {16, 32})
  {
    RectangleMesh mesh(rectangle(n, n));
    const auto conditions = bump_problem(2.3, 2.8, 0.03);
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver direct(mesh, law, conditions, settings);
    const std::size_t newton_iterations = direct.solve().iterations.size();
    settings.linear.direct_limit = 0;
    StaticSolver iterative(mesh, law, conditions, settings);
    const continuum::SolverReport report = iterative.solve();
    EXPECT_EQ(report.iterations.size(),
              newton_iterations); // linear solves are accurate enough for quadratic convergence
    EXPECT_NEAR(iterative.total_energy(), direct.total_energy(), 1e-12 * direct.total_energy());
    const auto left = direct.reactions().at(edge::left);
    EXPECT_NEAR((iterative.reactions().at(edge::left) - left).norm(), 0., 1e-9 * left.norm());
    unsigned int most = 0;
    for (const auto &iteration : report.iterations)
      most = std::max(most, iteration.linear_iterations);
    EXPECT_GT(most, 0u);
    most_iterations.push_back(most);
    RecordProperty("iterations at " + std::to_string(n), std::to_string(most));
  }
  // Constant under refinement, and as few as for any local law: 6 measured on both meshes.
  EXPECT_LE(most_iterations[1], most_iterations[0] + 1);
  EXPECT_LE(most_iterations[1], 9u);
}

// With an odd number of cells there is no coarser mesh: the whole system is the coarsest level, too large for KLU.
TEST(StaticSolver, SolvesOnAMeshThatCannotBeCoarsened)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  RectangleMesh mesh(rectangle(49, 29));
  const auto conditions = bump_problem(1.3, 1.5, 0.03);
  StaticSettings settings;
  settings.degree = 2;
  settings.linear.direct_limit = 0;
  StaticSolver iterative(mesh, law, conditions, settings);
  iterative.solve();
  settings.linear.direct_limit = 1000000;
  StaticSolver direct(mesh, law, conditions, settings);
  direct.solve();
  EXPECT_NEAR(iterative.total_energy(), direct.total_energy(), 1e-12 * direct.total_energy());
}

TEST(StaticSolver, RefusesImpossibleInput)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(2, 2));
  const auto held = affine(matrix(1., 0., 0., 1.));
  const auto refuses =
    [&](const std::vector<continuum::PrescribedDisplacement> &conditions, const StaticSettings &settings)
  { EXPECT_THROW(StaticSolver(mesh, law, conditions, settings), continuum::InvalidInput); };
  refuses({}, {});
  refuses({{7, held}}, {});
  refuses({{edge::left, nullptr}}, {});
  refuses({{edge::left, held, dealii::ComponentMask(std::vector<bool>{false, false})}}, {});
  StaticSettings no_degree, no_tolerance, long_step, no_step;
  no_degree.degree = 0;
  no_tolerance.relative_tolerance = 0.;
  long_step.first_load_step = 1.5;
  no_step.smallest_load_step = 0.;
  for (const StaticSettings &settings : {no_degree, no_tolerance, long_step, no_step})
    refuses({{edge::left, held}}, settings);

  Mesh empty(MPI_COMM_SELF);
  EXPECT_THROW(continuum::make_rectangle(empty, {0., 1., 1, 1}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_rectangle(empty, {1., 1., 1, 0}), continuum::InvalidInput);
  EXPECT_THROW(StaticSolver(empty, law, {{edge::left, held}}), continuum::InvalidInput);
}

TEST(StaticSolver, LeavesAnUnloadedSheetAtRest)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(4, 4));
  StaticSolver solver(mesh, law, on_all_edges(affine(matrix(1., 0., 0., 1.))));
  solver.solve();
  EXPECT_NEAR(solver.total_energy(), 0., 1e-14 * 5e5 * length * height);
  // Round-off of the stress at F = I, divided by the stiffness.
  EXPECT_LE(solver.displacement().linfty_norm(), 1e-15 * length);
}

// A law that can be made to fail.
class FragileLaw : public continuum::Material
{
public:
  continuum::Response evaluate(const Tensor<2, 2> &F, const continuum::Order order) const override
  {
    return whole().evaluate(F, order);
  }
  double thickness_stretch(const Tensor<2, 2> &F) const override { return law_.thickness_stretch(F); }
  bool is_broken = false;

private:
  const continuum::Material &whole() const
  {
    if (is_broken)
      throw continuum::NonPhysicalState("broken");
    return law_;
  }
  continuum::MooneyRivlin law_ = rubber_sheet();
};

// At an equilibrium nothing changes, and no system is solved. After a failure the state is that before it.
TEST(StaticSolver, EquilibratesWithoutLosingTheState)
{
  FragileLaw law;
  RectangleMesh mesh(rectangle(8, 6));
  StaticSettings settings;
  settings.degree = 2;
  settings.linear.direct_limit = 0;
  StaticSolver solver(mesh, law, bump_problem(1.3, 1.4, 0.01), settings);
  solver.solve();
  continuum::Sheet::Vector before = solver.sheet().make_ghosted();
  before = solver.displacement();
  const auto expect_unchanged = [&]
  {
    EXPECT_EQ(solver.load_factor(), 1.);
    for (const auto i : solver.sheet().owned())
      EXPECT_EQ(solver.displacement()(i), before(i));
  };
  const continuum::SolverReport report = solver.equilibrate();
  ASSERT_EQ(report.iterations.size(), 1u);
  EXPECT_EQ(report.iterations[0].linear_iterations, 0u);
  expect_unchanged();

  law.is_broken = true;
  EXPECT_THROW(solver.equilibrate(), continuum::SolverFailed);
  law.is_broken = false;
  expect_unchanged();
}

TEST(Sheet, EvaluatesOnCellBoundariesAndCorners)
{
  // Linear field: the gradient is equal in all adjacent cells, so their mean is exact.
  const continuum::CauchyBorn law = rubber_network();
  const Tensor<2, 2> F = matrix(1.3, 0.2, 0.1, 0.9);
  RectangleMesh mesh(rectangle(6, 4));
  StaticSolver solver(mesh, law, on_all_edges(affine(F)));
  solver.solve();
  const std::vector<Point<2>> points = {{0., -height / 2}, {length, height / 2}, {length / 2, 0.}, {length / 6, 0.013}};
  for (const auto &state : solver.evaluate(points))
  {
    EXPECT_NEAR((state.F - F).norm(), 0., 1e-9);
    EXPECT_NEAR((state.displacement - (F * Tensor<1, 2>(state.X) - Tensor<1, 2>(state.X))).norm(), 0., 1e-10 * length);
  }
  EXPECT_THROW(solver.evaluate({{1.01 * length, 0.}}), continuum::InvalidInput);
  EXPECT_THROW(solver.evaluate({{0., std::nan("")}}), continuum::InvalidInput);
}

} // namespace static_solver_test
