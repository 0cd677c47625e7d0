// Equilibrium with gradient energies: Newton's method, load steps, linear iterations, limits.
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "sheets.h"

#include <deal.II/base/function_parser.h>

#include <gtest/gtest.h>

namespace gradient_solver_test
{

using namespace latcon;
using namespace sheets;
using continuum::BoundaryConditions;
using continuum::Constitution;
using continuum::StaticSettings;
using continuum::StaticSolver;

constexpr double internal_length = 0.005;

// Conditions that hold displacement and normal gradient on all edges: normal gradient of the homogeneous stretch on
// three sides, zero at the top with the bump.
BoundaryConditions clamped_bump(const double stretch_x, const double stretch_y, const double bump)
{
  BoundaryConditions conditions(bump_problem(stretch_x, stretch_y, bump));
  conditions.normal_gradients.push_back(
    {continuum::edge::top, std::make_shared<Field>([](const Point<2> &) { return Tensor<1, 2>(); })});
  return conditions;
}

// Energy, residual and tangent of the discrete functional by Taylor's theorem at a state whose normal gradients jump
// everywhere, on a mesh with hanging nodes and a clamped edge; the tangent is symmetric. Without and with a penalty.
// theory-continuum.md, eqs. (C.28) to (C.30).
TEST(GradientEquilibrium, ResidualAndTangentAreDerivativesOfOneFunctional)
{
  using Vector = continuum::Sheet::Vector;
  const continuum::CauchyBorn law = rubber_network();
  const continuum::LatticeGradient lattice = rubber_gradient(2. * internal_length);
  const continuum::IsotropicGradient isotropic(5e5, internal_length);
  for (const continuum::GradientLaw *gradient :
       {static_cast<const continuum::GradientLaw *>(&lattice), static_cast<const continuum::GradientLaw *>(&isotropic)})
    for (const auto &[degree, penalty] : {std::pair(2u, 2.), std::pair(2u, 0.), std::pair(3u, 2.)})
    {
      RectangleMesh mesh(rectangle(2, 2));
      mesh.begin_active()->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
      Constitution laws(law, *gradient);
      laws.penalty = penalty;
      const continuum::Sheet sheet(mesh, laws, degree, clamped_bump(1.2, 1.3, 0.));
      std::mt19937 generator(17);
      const auto random = [&](const double amplitude)
      {
        std::uniform_real_distribution<double> entry(-amplitude, amplitude);
        Vector v = sheet.make_owned();
        for (const auto i : sheet.owned())
          v(i) = entry(generator);
        sheet.conformity_constraints().distribute(v);
        return v;
      };
      const auto ghosted = [&](const Vector &v)
      {
        Vector result = sheet.make_ghosted();
        result = v;
        return result;
      };
      // On cells of 2.5 to 7.5 cm; bonds stay stretched beyond the transition of (C.27), which finite differences would
      // not resolve.
      Vector u = random(2e-3);
      sheet.for_each_owned_dof(
        [&](const auto dof, const unsigned int i, const auto &X)
        {
          if (!sheet.conformity_constraints().is_constrained(dof))
            u(dof) = 0.4 * X[i] + 1e-4 * std::sin(900. * (X[0] + 2. * X[1]) + i);
        });
      sheet.conformity_constraints().distribute(u);
      const Vector v = random(1e-3);
      const Vector w = random(1e-3);

      Vector r = sheet.make_owned(), magnitude = sheet.make_owned(), Kv = sheet.make_owned(), Kw = sheet.make_owned();
      sheet.residual(ghosted(u), r, magnitude);
      continuum::Sheet::Matrix K;
      sheet.make_matrix(sheet.conformity_constraints(), K);
      sheet.tangent(ghosted(u), sheet.conformity_constraints(), K);
      // The rows of constrained unknowns contain a diagonal that does not belong to the functional.
      const auto product = [&](const Vector &x, Vector &Kx)
      {
        K.vmult(Kx, x);
        for (const auto i : sheet.owned())
          if (sheet.conformity_constraints().is_constrained(i))
            Kx(i) = 0.;
      };
      product(v, Kv);
      product(w, Kw);
      EXPECT_NEAR(v * Kw, w * Kv, 1e-12 * v.l2_norm() * Kw.l2_norm());

      const double E = sheet.energy(ghosted(u));
      const auto remainders = [&](const double h)
      {
        Vector moved = u;
        moved.add(h, v);
        sheet.conformity_constraints().distribute(moved);
        Vector there = sheet.make_owned();
        sheet.residual(ghosted(moved), there, magnitude);
        const double of_energy = std::abs(sheet.energy(ghosted(moved)) - E - h * (r * v));
        there -= r;
        there.add(-h, Kv);
        return std::make_pair(of_energy, there.l2_norm());
      };
      const auto coarse = remainders(1. / 8.);
      const auto fine = remainders(1. / 64.);
      EXPECT_GT(std::log2(coarse.first / fine.first) / 3., 1.9) << "degree " << degree;
      EXPECT_GT(std::log2(coarse.second / fine.second) / 3., 1.9) << "degree " << degree;
    }
}

// A notched sheet pulled to four times its height in one step: the step fails, and the solution equals that of small
// steps.
TEST(GradientEquilibrium, RecoversFromALoadStepThatFails)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.2 * internal_length);
  const auto field = affine(matrix(1., 0., 0., 4.));
  const auto solve = [&](const double first_load_step)
  {
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_notched_rectangle(mesh, {length, height, 0.06, 1});
    StaticSettings settings;
    settings.first_load_step = first_load_step;
    StaticSolver solver(mesh, Constitution(law, gradient),
                        {{continuum::edge::bottom, field}, {continuum::edge::top, field}}, settings);
    const continuum::SolverReport report = solver.solve();
    unsigned int rejected = 0;
    for (const auto &step : report.load_steps)
      rejected += step.accepted ? 0 : 1;
    EXPECT_GT(solver.determinant_range().smallest, 0.);
    return std::make_pair(rejected, solver.total_energy());
  };
  const auto [rejected, energy] = solve(1.);
  const auto [rejected_slowly, energy_slowly] = solve(0.0625);
  EXPECT_GT(rejected, 0u);
  EXPECT_NEAR(energy, energy_slowly, 1e-9 * energy);
}

// Iterations of conjugate gradients within Newton's method, at finite strain, over a refinement and on adaptive
// meshes. Measured: 14, 17 and, on twice as fine a mesh, 19 with degree 2, and 8, 9, 9 with degree 3.
TEST(GradientEquilibrium, LinearIterationsDependLittleOnTheMesh)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.1 * height);
  for (const unsigned int degree : {2u, 3u})
  {
    std::vector<unsigned int> most;
    StaticSettings settings;
    settings.degree = degree;
    settings.linear.direct_limit = 0;
    settings.linear.multigrid.coarsest_size = 150;
    settings.largest_forcing = 0.;
    settings.linear.rebuild_ratio = 0.;
    const auto largest = [](const continuum::SolverReport &report)
    {
      unsigned int result = 0;
      for (const auto &iteration : report.iterations)
        result = std::max(result, iteration.linear_iterations);
      return result;
    };
    for (const unsigned int n : {12u, 24u})
    {
      RectangleMesh mesh(rectangle(n, n / 3 * 2));
      StaticSolver solver(mesh, Constitution(law, gradient), clamped_bump(1.5, 1.8, 0.02), settings);
      most.push_back(largest(solver.solve()));
      if (n == 12u)
      {
        for (unsigned int cycle = 0; cycle < 2; ++cycle)
        {
          solver.refine(mesh, 0.1);
          const continuum::SolverReport report = solver.equilibrate();
          EXPECT_LE(largest(report), degree == 2 ? 20u : 10u) << report.text();
        }
      }
    }
    EXPECT_LE(most[1], 1.25 * most[0]) << most[0] << " " << most[1];
    EXPECT_LE(most[1], degree == 2 ? 18u : 10u);
  }
}

// Inexact linear solves: the same equilibrium at lower cost, with at most two additional Newton steps, of which the
// last are as large as exact steps.
TEST(GradientEquilibrium, InexactStepsEndAtTheSameEquilibrium)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.1 * height);
  struct Answer
  {
    double energy;
    std::vector<continuum::PointState> states;
    std::size_t n_steps;
    unsigned int n_linear;
  };
  const auto solve = [&](const double largest_forcing)
  {
    RectangleMesh mesh(rectangle(12, 8));
    StaticSettings settings;
    settings.degree = 2;
    settings.linear.direct_limit = 0;
    settings.linear.multigrid.coarsest_size = 150;
    settings.largest_forcing = largest_forcing;
    StaticSolver solver(mesh, Constitution(law, gradient), clamped_bump(1.5, 1.8, 0.02), settings);
    const continuum::SolverReport report = solver.solve();
    EXPECT_LE(report.iterations.back().residual, report.iterations.back().tolerance);
    unsigned int n_linear = 0;
    for (const auto &iteration : report.iterations)
      n_linear += iteration.linear_iterations;
    return Answer{solver.total_energy(), solver.evaluate(scattered_points(7, 5)), report.iterations.size(), n_linear};
  };
  const Answer exact = solve(0.);
  for (const double largest_forcing : {StaticSettings().largest_forcing, 0.1})
  {
    const Answer inexact = solve(largest_forcing);
    EXPECT_LE(inexact.n_steps, exact.n_steps + 2);
    EXPECT_LT(inexact.n_linear, exact.n_linear);
    // The energy is stationary, so its error is quadratic: only round-off remains.
    EXPECT_NEAR(inexact.energy, exact.energy, 1e-12 * exact.energy);
    // Residuals are 1e-10 of the forces.
    for (std::size_t p = 0; p < exact.states.size(); ++p)
      EXPECT_LT((inexact.states[p].displacement - exact.states[p].displacement).norm(), 1e-9 * length);
  }
}

// With zero length the gradient law has no effect; in homogeneous states it has no effect at any length.
TEST(GradientEquilibrium, IsLocalWithoutLengthAndInHomogeneousStates)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(6, 4));
  const auto energy = [&](const Constitution &constitution, const BoundaryConditions &conditions)
  {
    StaticSolver solver(mesh, constitution, conditions);
    solver.solve();
    return solver.total_energy();
  };
  const continuum::IsotropicGradient none(5e5, 0.), tiny(5e5, 1e-7), large(5e5, 0.05);
  const BoundaryConditions bump(bump_problem(2., 2.2, 0.03));
  const double local = energy(law, bump);
  EXPECT_EQ(energy(Constitution(law, none), bump), local);
  EXPECT_NEAR(energy(Constitution(law, tiny), bump), local, 1e-6 * local);
  EXPECT_GT(energy(Constitution(law, large), bump), 1.01 * local);
  const BoundaryConditions homogeneous(on_all_edges(affine(matrix(2.3, 0.1, -0.2, 2.8))));
  const double flat = energy(law, homogeneous);
  EXPECT_NEAR(energy(Constitution(law, large), homogeneous), flat, 1e-12 * flat);
  EXPECT_NEAR(energy(Constitution(law, rubber_gradient(0.01)), homogeneous), flat, 1e-12 * flat);
}

// Law that vanishes at F = I and not under strain.
class StiffeningGradient : public continuum::IsotropicGradient
{
public:
  using IsotropicGradient::IsotropicGradient;
  continuum::GradientResponse evaluate(const Tensor<2, 2> &F, const Gradient &G,
                                       const continuum::Order order) const override
  {
    continuum::GradientResponse W = IsotropicGradient::evaluate(F, G, order);
    W.double_stress_by_G *= (F - dealii::unit_symmetric_tensor<2>()).norm();
    return W;
  }
};

// Only is_zero() of the law decides whether there is a gradient energy, regardless of its stiffness at F = I.
TEST(GradientEquilibrium, TakesALawForZeroOnlyIfItSaysSo)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(2, 2));
  const continuum::IsotropicGradient none(5e5, 0.), some(5e5, 0.01);
  const StiffeningGradient stiffening(5e5, 0.01);
  EXPECT_FALSE(Constitution(law).has_gradient());
  EXPECT_FALSE(Constitution(law, none).has_gradient());
  EXPECT_TRUE(Constitution(law, some).has_gradient());
  EXPECT_TRUE(Constitution(law, stiffening).has_gradient());
  EXPECT_FALSE(continuum::Sheet(mesh, Constitution(law, none), 2).has_gradient());
  EXPECT_TRUE(continuum::Sheet(mesh, Constitution(law, some), 2).has_gradient());
  EXPECT_EQ(stiffening.normal_stiffness(), 0.);
  EXPECT_TRUE(continuum::Sheet(mesh, Constitution(law, stiffening), 2).has_gradient());
}

// (1 - l^2 Laplace) multiplies a sinusoidal force of wave number k by 1 + l^2 k^2 for every shape function; the
// boundary integral compensates the partial integration. theory-continuum.md, eq. (C.32).
TEST(GradientEquilibrium, CorrectsTheBodyForceOfMicroInertia)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(12, 8));
  const double k = 40.;
  const auto force = std::make_shared<dealii::FunctionParser<2>>(2, 0., 1e-4);
  force->set_formula(dealii::AutoDerivativeFunction<2>::FourthOrder);
  force->initialize("x,y", std::vector<std::string>{"1e5*sin(40*(0.6*x+0.8*y)+0.3)", "2e5*cos(40*(0.8*x-0.6*y))"}, {});
  const auto loads = [&](const double with_length)
  {
    BoundaryConditions conditions(on_all_edges(affine(matrix(1., 0., 0., 1.))));
    conditions.body_force = continuum::BodyForce{force, with_length};
    return continuum::Sheet(mesh, law, 3, conditions).loads();
  };
  continuum::Sheet::Vector plain = loads(0.);
  continuum::Sheet::Vector corrected = loads(0.02);
  plain *= 1. + std::pow(0.02 * k, 2);
  corrected -= plain;
  // Gauss quadrature of degree 9 on cells of half a radian, and fourth-order differences: both errors are below 1e-8.
  EXPECT_LT(corrected.linfty_norm(), 1e-7 * plain.linfty_norm());
}

TEST(GradientEquilibrium, RefusesImpossibleInput)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, internal_length);
  RectangleMesh mesh(rectangle(2, 2));
  const auto field = affine(matrix(1., 0., 0., 1.));
  BoundaryConditions conditions(on_all_edges(field));
  StaticSettings linear;
  linear.degree = 1;
  EXPECT_THROW(StaticSolver(mesh, Constitution(law, gradient), conditions, linear), continuum::InvalidInput);
  // Without a gradient energy, normal gradients cannot be prescribed and double tractions do no work.
  const continuum::IsotropicGradient zero(5e5, 0.);
  BoundaryConditions held = conditions, loaded = conditions;
  held.normal_gradients.push_back({0, field});
  loaded.double_tractions.push_back({0, field});
  for (const BoundaryConditions &impossible : {held, loaded})
  {
    EXPECT_THROW(StaticSolver(mesh, law, impossible), continuum::InvalidInput);
    EXPECT_THROW(StaticSolver(mesh, Constitution(law, zero), impossible), continuum::InvalidInput);
    EXPECT_NO_THROW(StaticSolver(mesh, Constitution(law, gradient), impossible));
  }
  StaticSettings careless;
  careless.largest_forcing = 1.;
  EXPECT_THROW(StaticSolver(mesh, Constitution(law, gradient), conditions, careless), continuum::InvalidInput);
  Constitution constitution(law, gradient);
  constitution.penalty = -1.;
  EXPECT_THROW(StaticSolver(mesh, constitution, conditions), continuum::InvalidInput);
  conditions.normal_gradients.push_back({continuum::edge::top, field});
  EXPECT_NO_THROW(StaticSolver(mesh, Constitution(law, gradient), conditions));
  EXPECT_THROW(StaticSolver(mesh, law, conditions), continuum::InvalidInput);
  conditions.normal_gradients = {{9, field}};
  EXPECT_THROW(StaticSolver(mesh, Constitution(law, gradient), conditions), continuum::InvalidInput);
  conditions.normal_gradients.clear();
  conditions.double_tractions.push_back({continuum::edge::top, field});
  EXPECT_THROW(StaticSolver(mesh, law, conditions), continuum::InvalidInput);
  conditions.double_tractions.clear();
  conditions.body_force = continuum::BodyForce{field, -1.};
  EXPECT_THROW(StaticSolver(mesh, law, conditions), continuum::InvalidInput);
}

} // namespace gradient_solver_test
