// Static solver on one rank: exactness, reactions, linear solvers, Newton's method, load steps, and refusals.
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

namespace static_solver_test
{

using namespace sheets;
using namespace latcon::continuum;

const CauchyBorn network = rubber_network();
const MooneyRivlin rubber = rubber_sheet();

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
  std::vector<Point<2>> points = scattered_points();
  for (const Point<2> &on_edge : {Point<2>(0., -height / 2), Point<2>(length, height / 2), Point<2>(length / 6, 0.05)})
    points.push_back(on_edge);
  for (const Material *law : {static_cast<const Material *>(&network), static_cast<const Material *>(&rubber)})
    for (const unsigned int degree : {1, 2, 3})
    {
      RectangleMesh mesh(rectangle(6, 4));
      distort(mesh, 6, 4);
      StaticSettings settings;
      settings.degree = degree;
      settings.relative_tolerance = 1e-12;
      auto conditions = on_all_edges(affine(F));
      conditions[0].components = dealii::ComponentMask(std::vector<bool>{true, false}); // one component at a time
      conditions.push_back({edge::left, affine(F), dealii::ComponentMask(std::vector<bool>{false, true})});
      StaticSolver solver(mesh, *law, conditions, settings);
      solver.solve();

      const double W = law->energy(F);
      const Tensor<2, 2> P = law->first_piola_stress(F);
      for (const auto &state : solver.sheet().evaluate(solver.displacement(), points))
      {
        EXPECT_NEAR((state.displacement - (F * Tensor<1, 2>(state.X) - Tensor<1, 2>(state.X))).norm(), 0.,
                    1e-10 * length);
        EXPECT_NEAR((state.F - F).norm(), 0., 1e-10);
        EXPECT_NEAR((state.P - P).norm(), 0., 1e-10 * law->tangent(F).norm());
        EXPECT_NEAR(state.energy_density, W, 1e-10 * W);
      }
      EXPECT_NEAR(solver.total_energy(), W * length * height, 1e-10 * W * length * height);
      EXPECT_NEAR(solver.sheet().determinant_range(solver.displacement()).smallest, determinant(F), 1e-10);
      EXPECT_NEAR(solver.sheet().determinant_range(solver.displacement()).largest, determinant(F), 1e-10);

      // Reactions are P N times the reference length of the edge.
      const auto reactions = solver.reactions();
      const double force = P.norm() * length;
      EXPECT_NEAR((reactions.at(edge::right) - height * P * Tensor<1, 2>({1., 0.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::left) + height * P * Tensor<1, 2>({1., 0.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::top) - length * P * Tensor<1, 2>({0., 1.})).norm(), 0., 1e-10 * force);
      EXPECT_NEAR((reactions.at(edge::bottom) + length * P * Tensor<1, 2>({0., 1.})).norm(), 0., 1e-10 * force);
    }
}

// theory-continuum.md, eqs. (C.15) and (C.18).
TEST(StaticSolver, ReactionIsTheDerivativeOfTheEnergy)
{
  // dE/d(load factor) = reaction of the top edge times its unit displacement, with all other edges fixed.
  RectangleMesh mesh(rectangle(8, 8));
  const auto energy_and_reaction = [&](const double lift)
  {
    const auto raised = std::make_shared<Field>(
      [lift](const Point<2> &X) {
        return Tensor<1, 2>({(0.4 + 2. * X[0]) * X[0], (X[1] > 0. ? lift : 0.)});
      });
    const auto wall = std::make_shared<Field>([](const Point<2> &) { return Tensor<1, 2>({0., 1.}); });
    // Not the second component of the wall, which other edges hold at its ends.
    const auto sides = dealii::ComponentMask(std::vector<bool>{true, false});
    StaticSolver solver(mesh, network, {{edge::left, wall, sides}, {edge::top, raised}, {edge::bottom, raised}});
    solver.solve();
    return std::make_pair(solver.total_energy(), solver.reactions().at(edge::top)[1]);
  };
  const double lift = 0.05;
  const double h = 1e-4 * lift;
  const double slope = (energy_and_reaction(lift + h).first - energy_and_reaction(lift - h).first) / (2. * h);
  // Central difference: relative truncation of the order of (h/lift)^2 = 1e-8, round-off of 1e-16/1e-4 = 1e-12.
  EXPECT_NEAR(energy_and_reaction(lift).second, slope, 1e-7 * slope);
}

// On a mesh that can be coarsened, with hanging nodes or without, and on one with an odd number of cells, which is the
// coarsest level itself. Where coarser meshes exist the finest one starts from their solution: without a predictor, and
// within the error of cells of twice the size.
TEST(StaticSolver, ConjugateGradientsAgreeWithDirectSolver)
{
  for (const unsigned int n : {16, 15, 8})
  {
    SCOPED_TRACE(n);
    RectangleMesh mesh(rectangle(n, n));
    if (n == 8)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && cell->center()[0] < length / 2)
          cell->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
    }
    const auto conditions = bump_problem(2.3, 2.8, 0.03);
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver direct(mesh, rubber, conditions, settings);
    const SolverReport expected = direct.solve();
    settings.linear.direct_limit = 0;
    settings.linear.coarsest_size = 300;
    StaticSolver iterative(mesh, rubber, conditions, settings);
    const SolverReport report = iterative.solve();
    const double energy = direct.total_energy();
    if (n == 15)
    {
      // Linear solves are accurate enough for quadratic convergence.
      EXPECT_EQ(report.iterations.size(), expected.iterations.size());
      EXPECT_GT(report.iterations.front().linear_iterations, 0u);
    }
    else
    {
      EXPECT_LE(report.iterations.size(), expected.iterations.size());
      EXPECT_EQ(report.iterations.front().linear_iterations, 0u);
      EXPECT_LT(std::abs(report.iterations.front().energy - energy),
                0.1 * std::abs(expected.iterations.front().energy - energy));
    }
    EXPECT_EQ(report.load_steps.size(), 1u);
    EXPECT_EQ(iterative.load_factor(), 1.);
    EXPECT_NEAR(iterative.total_energy(), energy, 1e-12 * energy);
    const auto left = direct.reactions().at(edge::left);
    EXPECT_NEAR((iterative.reactions().at(edge::left) - left).norm(), 0., 1e-9 * left.norm());
    EXPECT_GT(most_linear_iterations(report), 0u);
    EXPECT_LE(most_linear_iterations(report), 9u);
  }
}

// A wavy edge that coarser meshes do not see folds the cells of a state interpolated from there.
TEST(StaticSolver, StartsAnewIfTheStateOfACoarserMeshFails)
{
  constexpr unsigned int n = 8;
  const auto waves = std::make_shared<Field>(
    [](const Point<2> &X)
    {
      const double on_top = X[1] > 0.499 * height ? std::pow(std::sin(n * pi * X[0] / length), 2) : 0.;
      return Tensor<1, 2>({0.3 * X[0], 0.4 * X[1] - 0.7 * height / n * on_top});
    });
  RectangleMesh mesh(rectangle(n, n));
  StaticSettings settings;
  settings.degree = 2;
  StaticSolver direct(mesh, rubber, on_all_edges(waves), settings);
  direct.solve();
  settings.linear.direct_limit = 0;
  settings.linear.coarsest_size = 300;
  StaticSolver iterative(mesh, rubber, on_all_edges(waves), settings);
  std::vector<double> load_factors;
  const SolverReport report = iterative.solve([&](const double load_factor) { load_factors.push_back(load_factor); });
  EXPECT_FALSE(report.load_steps.front().accepted);
  EXPECT_EQ(report.load_steps.front().load_factor, 1.);
  EXPECT_TRUE(report.load_steps.back().accepted);
  EXPECT_EQ(iterative.load_factor(), 1.);
  ASSERT_FALSE(load_factors.empty());
  EXPECT_EQ(load_factors.back(), 1.);
  EXPECT_NEAR(iterative.total_energy(), direct.total_energy(), 1e-12 * direct.total_energy());
}

// A law that can be made to fail.
class FragileLaw : public Material
{
public:
  Response evaluate(const Tensor<2, 2> &F, const Order order) const override
  {
    if (is_broken)
      throw NonPhysicalState("broken");
    return rubber.evaluate(F, order);
  }
  bool is_broken = false;
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
  const Sheet::Vector before = ghosted(solver.sheet(), solver.displacement());
  const auto expect_unchanged = [&]
  {
    EXPECT_EQ(solver.load_factor(), 1.);
    for (const auto i : solver.sheet().owned())
      EXPECT_EQ(solver.displacement()(i), before(i));
  };
  const SolverReport report = solver.equilibrate();
  ASSERT_EQ(report.iterations.size(), 1u);
  EXPECT_EQ(report.iterations[0].linear_iterations, 0u);
  expect_unchanged();

  law.is_broken = true;
  EXPECT_THROW(solver.equilibrate(), SolverFailed);
  law.is_broken = false;
  expect_unchanged();
}

// Boundary values are those of the prescribed function, not of its interpolation on the coarser edge.
TEST(StaticSolver, HoldsTheBoundaryOnARefinedMesh)
{
  RectangleMesh mesh(rectangle(4, 4));
  const auto conditions = bump_problem(1.3, 1.4, 0.01);
  StaticSolver solver(mesh, rubber, conditions);
  solver.solve();
  solver.refine(mesh, 1.);
  solver.sheet().for_each_owned_dof(
    [&](const auto dof, const unsigned int component, const Point<2> &X)
    {
      if (X[1] > 0.4999 * height)
      {
        EXPECT_NEAR(solver.displacement()(dof), conditions[0].field->value(X, component), 1e-14);
      }
    });
}

// theory-continuum.md, eqs. (C.16) and (C.17): the forces of the residual balance, and the tangent is its derivative.
TEST(StaticSolver, NewtonIsQuadratic)
{
  RectangleMesh mesh(rectangle(12, 8));
  const Tensor<1, 2> load({1e5, -2e5}); // [N/m^3]
  BoundaryConditions conditions(bump_problem(2.3, 2.8, 0.03));
  conditions.body_force = BodyForce{std::make_shared<Field>([load](const Point<2> &) { return load; })};
  StaticSolver solver(mesh, rubber, conditions);
  const SolverReport report = solver.solve();
  EXPECT_EQ(report.load_steps.size(), 1u) << report.text();
  // Between the first three residuals the tangent is not kept.
  const std::vector<NewtonIteration> &all = report.iterations;
  ASSERT_GE(all.size(), 3u) << report.text();
  EXPECT_GT(all[1].residual, 0.01 * all[0].residual);
  EXPECT_GE(newton_order(all, 0), 1.8) << report.text();
  for (std::size_t k = 1; k < all.size(); ++k)
  {
    EXPECT_EQ(all[k].step_length, 1.);
    EXPECT_TRUE(k < 2 || all[k].residual <= 0.01 * all[k - 1].residual) << report.text();
  }
  EXPECT_LE(report.iterations.size(), 7u) << report.text();

  Tensor<1, 2> sum = load * length * height;
  double size = 0.;
  for (const auto &[boundary, force] : solver.reactions())
  {
    sum += force;
    size += force.norm();
  }
  // Free residuals are at most 1e-10 of the reactions, and the sum is off by these residuals.
  EXPECT_NEAR(sum.norm(), 0., 1e-10 * size);
}

TEST(StaticSolver, CutsALoadStepThatIsTooBig)
{
  // The bump pushes the top edge half way down: in a single step the predictor inverts cells.
  const MooneyRivlin law = rubber_sheet(0.1);
  RectangleMesh mesh(rectangle(12, 8));
  const auto conditions = bump_problem(1.2, 1.2, -0.07);
  StaticSettings settings;
  settings.degree = 2;
  StaticSolver at_once(mesh, law, conditions, settings);
  const SolverReport report = at_once.solve();
  EXPECT_FALSE(report.load_steps.front().accepted) << report.text();
  EXPECT_FALSE(report.load_steps.front().reason.empty());
  EXPECT_TRUE(report.load_steps.back().accepted);
  EXPECT_EQ(at_once.load_factor(), 1.);

  settings.first_load_step = 1. / 64.;
  StaticSolver step_by_step(mesh, law, conditions, settings);
  step_by_step.solve();
  // Residuals of 1e-10 of the reactions give an energy error of the order of their square: only round-off remains.
  EXPECT_NEAR(at_once.total_energy(), step_by_step.total_energy(), 1e-12 * step_by_step.total_energy());
}

TEST(StaticSolver, BacktracksOnEnergy)
{
  // Springs in compression soften, so a large compression needs steps shorter than full Newton steps.
  RectangleMesh mesh(rectangle(12, 8));
  StaticSolver solver(mesh, network, bump_problem(1.1, 1.1, -0.045));
  const SolverReport report = solver.solve();
  double shortest = 1.;
  for (const auto &iteration : report.iterations)
    shortest = std::min(shortest, iteration.step_length);
  EXPECT_LT(shortest, 1.) << report.text();
  for (std::size_t k = 1; k < report.iterations.size(); ++k)
    if (report.iterations[k].iteration > 0)
    {
      EXPECT_LE(report.iterations[k].energy, report.iterations[k - 1].energy * (1. + 1e-13)) << report.text();
    }
  EXPECT_EQ(solver.load_factor(), 1.);
}

TEST(StaticSolver, ThrowsWithHistoryWhenItDoesNotConverge)
{
  // The right edge is pushed through the left one, which no load step can reach.
  const MooneyRivlin law = rubber_sheet(0.1);
  RectangleMesh mesh(rectangle(6, 4));
  StaticSettings settings;
  settings.smallest_load_step = 1. / 16.;
  StaticSolver solver(mesh, law, on_all_edges(affine(matrix(-0.5, 0., 0., 1.))), settings);
  try
  {
    solver.solve();
    FAIL() << "converged";
  }
  catch (const SolverFailed &failure)
  {
    const auto &report = failure.report();
    EXPECT_FALSE(report.iterations.empty());
    EXPECT_FALSE(report.load_steps.back().accepted);
    double reached = 0.;
    for (std::size_t n = 0; n + 1 < report.load_steps.size(); ++n)
    {
      const LoadStep &step = report.load_steps[n];
      if (step.accepted)
        reached = step.load_factor;
      else // half of what was refused
        EXPECT_EQ(report.load_steps[n + 1].load_factor, 0.5 * (reached + step.load_factor)) << report.text();
    }
    EXPECT_GT(solver.load_factor(), 0.5);
    EXPECT_LT(solver.load_factor(), 2. / 3.); // where det F = 0
    EXPECT_EQ(reached, solver.load_factor());
    EXPECT_NE(std::string(failure.what()).find("residual"), std::string::npos);
    EXPECT_NE(std::string(failure.what()).find("det F"), std::string::npos);
  }
  EXPECT_GT(solver.sheet().determinant_range(solver.displacement()).smallest, 0.); // the last accepted state

  settings.max_newton_iterations = 0;
  StaticSolver without_iterations(mesh, network, bump_problem(2.3, 2.8, 0.03), settings);
  EXPECT_THROW(without_iterations.solve(), SolverFailed);
  EXPECT_EQ(without_iterations.load_factor(), 0.);
}

// theory-continuum.md, eq. (C.19).
TEST(StaticSolver, StopsAtTheRoundOffOfTheResidual)
{
  // With a tolerance below round-off, the floor ends the iteration, on coarse and fine meshes. The floor must be within
  // a factor of 100 of the residual reached, so it is not too large.
  for (const auto &[n, strain] : {std::pair(4u, 1.), {16u, 1.}, {16u, 1e-3}, {16u, 1e-8}})
  {
    RectangleMesh mesh(rectangle(n, n));
    StaticSettings settings;
    settings.relative_tolerance = 1e-30;
    StaticSolver solver(mesh, rubber, bump_problem(1. + 1.3 * strain, 1. + 1.8 * strain, 0.03 * strain), settings);
    const NewtonIteration last = solver.solve().iterations.back();
    EXPECT_LE(last.residual, last.tolerance);
    EXPECT_GE(last.residual, 0.01 * last.tolerance);
  }

  // Where the only free node does not move, there is the round-off of stresses alone.
  RectangleMesh mesh(rectangle(2, 2));
  const Point<2> node(0.4 * length, 0.1 * height);
  mesh.begin_active()->vertex(3) = node;
  const Tensor<2, 2> F = matrix(1.8, 0.2, 0.1, 1.4);
  const auto about_node =
    std::make_shared<Field>([&](const Point<2> &X) { return F * Tensor<1, 2>(X - node) - Tensor<1, 2>(X - node); });
  StaticSettings settings;
  settings.degree = 1;
  settings.relative_tolerance = 1e-30;
  const NewtonIteration last = StaticSolver(mesh, rubber, on_all_edges(about_node), settings).solve().iterations.back();
  EXPECT_GT(last.tolerance, 1e-16 * rubber.first_piola_stress(F).norm() * height);
}

// A force along x that balances itself, for which the roller at the left needs none.
TEST(StaticSolver, MeasuresTheResidualByDeadLoadsAsWell)
{
  RectangleMesh mesh(rectangle(12, 2));
  const auto zero = affine(matrix(1., 0., 0., 1.));
  BoundaryConditions conditions{{edge::left, zero, dealii::ComponentMask(std::vector<bool>{true, false})},
                                {edge::bottom, zero, dealii::ComponentMask(std::vector<bool>{false, true})}};
  conditions.body_force = BodyForce{std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({1e4 * std::sin(2. * pi * X[0] / length), 0.});
    })};
  StaticSettings settings;
  StaticSolver solver(mesh, rubber, conditions, settings);
  const NewtonIteration last = solver.solve().iterations.back();
  EXPECT_GE(last.tolerance, settings.relative_tolerance * solver.sheet().loads().l2_norm());
}

TEST(StaticSolver, RefusesImpossibleInput)
{
  RectangleMesh mesh(rectangle(2, 2));
  const auto held = affine(matrix(1., 0., 0., 1.));
  const auto refuses = [&](const std::vector<BoundaryField> &conditions, const StaticSettings &settings)
  { EXPECT_THROW(StaticSolver(mesh, network, conditions, settings), InvalidInput); };
  refuses({}, {});
  refuses({{7, held}}, {});
  refuses({{edge::left, nullptr}}, {});
  refuses({{edge::left, held, dealii::ComponentMask(std::vector<bool>{false, false})}}, {});
  StaticSettings no_degree, no_tolerance, long_step, no_step, careless;
  no_degree.degree = 0;
  no_tolerance.relative_tolerance = 0.;
  long_step.first_load_step = 1.5;
  no_step.smallest_load_step = 0.;
  careless.largest_forcing = 1.;
  for (const StaticSettings &settings : {no_degree, no_tolerance, long_step, no_step, careless})
    refuses({{edge::left, held}}, settings);

  const StaticSolver solver(mesh, network, {{edge::left, held}});
  EXPECT_THROW(solver.sheet().evaluate(solver.displacement(), {{1.01 * length, 0.}}), InvalidInput);
  EXPECT_THROW(solver.sheet().evaluate(solver.displacement(), {{0., std::nan("")}}), InvalidInput);
  Mesh empty(MPI_COMM_SELF);
  EXPECT_THROW(StaticSolver(empty, network, {{edge::left, held}}), InvalidInput);
}

} // namespace static_solver_test
