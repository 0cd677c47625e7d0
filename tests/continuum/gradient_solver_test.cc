// Equilibrium with gradient energies: the discrete functional and its lifted gradients, which are stable on skewed
// cells; inexact steps, limits and refusals.
#include "continuum/errors.h"
#include "continuum/rate_forces.h"
#include "moving_sheets.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

namespace gradient_solver_test
{

using namespace moving_sheets;
using namespace latcon::continuum;

constexpr double internal_length = 0.005;
const CauchyBorn law = rubber_network();
using Vector = Sheet::Vector;

// Conditions that hold displacement and normal gradient on all edges: normal gradient of the homogeneous stretch on
// three sides, zero at the top with the bump.
BoundaryConditions clamped_bump(const double stretch_x, const double stretch_y, const double bump)
{
  BoundaryConditions conditions(bump_problem(stretch_x, stretch_y, bump));
  conditions.normal_gradients.push_back(
    {edge::top, std::make_shared<Field>([](const Point<2> &) { return Tensor<1, 2>(); })});
  return conditions;
}

// Energy, residual and tangent of the discrete functional by Taylor's theorem at a state whose normal gradients jump
// everywhere, on a mesh with hanging nodes and a clamped edge; the tangent is symmetric. Without and with a penalty.
// theory-continuum.md, eq. (C.28), with (C.16) and (C.17).
TEST(GradientEquilibrium, ResidualAndTangentAreDerivativesOfOneFunctional)
{
  const LatticeGradient lattice = rubber_gradient(2. * internal_length);
  const IsotropicGradient isotropic(5e5, internal_length);
  for (const GradientLaw *gradient :
       {static_cast<const GradientLaw *>(&lattice), static_cast<const GradientLaw *>(&isotropic)})
    for (const auto &[degree, penalty] : {std::pair(2u, 2.), std::pair(2u, 0.), std::pair(3u, 2.)})
    {
      RectangleMesh mesh(rectangle(2, 2));
      mesh.begin_active()->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
      Constitution laws(law, *gradient);
      laws.penalty = penalty;
      const Sheet sheet(mesh, laws, degree, clamped_bump(1.2, 1.3, 0.));
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
      // On cells of 2.5 to 7.5 cm; bonds stay stretched beyond the transition of (C.27), which finite differences would
      // not resolve.
      const Vector u = owned(
        sheet,
        nodal(sheet,
              [](const Point<2> &X)
              {
                const double wave = 900. * (X[0] + 2. * X[1]);
                return Tensor<1, 2>({0.4 * X[0] + 1e-4 * std::sin(wave), 0.4 * X[1] + 1e-4 * std::sin(wave + 1.)});
              }));
      const Vector v = random(1e-3);
      const Vector w = random(1e-3);

      Vector r = sheet.make_owned(), magnitude = sheet.make_owned(), Kv = sheet.make_owned(), Kw = sheet.make_owned();
      EXPECT_EQ(sheet.residual(ghosted(sheet, u), r, magnitude), sheet.energy(ghosted(sheet, u)));
      Sheet::Matrix K;
      sheet.make_matrix(sheet.conformity_constraints(), K);
      sheet.tangent(ghosted(sheet, u), sheet.conformity_constraints(), K);
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

      const double E = sheet.energy(ghosted(sheet, u));
      const auto remainders = [&](const double h)
      {
        Vector moved = u;
        moved.add(h, v);
        sheet.conformity_constraints().distribute(moved);
        Vector there = sheet.make_owned();
        sheet.residual(ghosted(sheet, moved), there, magnitude);
        const double of_energy = std::abs(sheet.energy(ghosted(sheet, moved)) - E - h * (r * v));
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

// The lifting of a kink u_y = s max(0, X - a) along a column of faces in a strip of squares of side h that is periodic
// along Y: in both cells beside a face, whose n is 4, R is a polynomial of degree p - 1 across the face with the
// squared mean (s p / 2 h)^2, so that W_g = c |G|^2 / 2 has the energy n c s^2 p^2 / 4 h per length of the column, and
// dashpots at rest dissipate n p^2 / 2 h times the power of the rate s e_y (x) NN. theory-continuum.md, eqs. (C.59) and
// (C.63). Where cells on the right are half as large, a cell on the left has n = 5, and R of each half of its face is
// the projection of what vanishes along the other half.
TEST(GradientEquilibrium, LiftsAKinkAsInClosedForm)
{
  const IsotropicGradient gradient(5e5, 0.01);
  const FibreViscosity local_dashpots = network_viscosity(300.);
  const FibreViscosity dashpots = network_viscosity(300., 0.01);
  constexpr double h = 0.02, s = 0.3;
  FieldDerivatives rate{};
  rate[1][n_first] = s;
  PointIntegrand power;
  clear(power, Order::value);
  dashpots.gradient()->add_density({}, rate, Order::value, 0., power);
  // Degree, n of the cells on the left times their squared projections, and size of the cells on the right.
  for (const auto &[p, n_left, h_right] :
       {std::tuple(2u, 4., h), std::tuple(3u, 4., h), std::tuple(4u, 4., h), std::tuple(2u, 5. * 7. / 8., h / 2.),
        std::tuple(3u, 5. * 7. / 8., h / 2.), std::tuple(4u, 5. * 119. / 128., h / 2.)})
  {
    RectangleMesh mesh({4. * h, 2. * h, 4, 2, false, true});
    for (const auto &cell : mesh.active_cell_iterators())
      if (h_right < h && cell->center()[0] > 2. * h)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
    const double n_by_h = 0.5 * (n_left / h + 4. / h_right);
    BoundaryConditions along_y;
    along_y.periodic = {{edge::bottom, edge::top, 1}};
    Constitution laws(law, gradient);
    laws.penalty = 0.;
    const Sheet with(mesh, laws, p, along_y), without(mesh, law, p, along_y);
    const auto u = nodal(with, [](const Point<2> &X) { return Tensor<1, 2>({0., s * std::max(0., X[0] - 2. * h)}); });
    const double expected = n_by_h * gradient.modulus() * s * s * p * p / 4. * 2. * h;
    // Round-off of two energies of the order of 1e3 J/m.
    EXPECT_NEAR(with.energy(u) - without.energy(u), expected, 1e-11 * without.energy(u)) << p;
    const double of_stretches = RateForces(with, &local_dashpots, nullptr).dissipation(with.make_ghosted(), u);
    const double of_both = RateForces(with, &dashpots, nullptr).dissipation(with.make_ghosted(), u);
    EXPECT_NEAR(of_both - of_stretches, power.value * n_by_h * p * p / 2. * 2. * h, 1e-10 * of_both) << p;
  }
}

// Cells skewed by a shear of 3, for which a penalty that suffices for squares would be too small.
TEST(GradientEquilibrium, StaysCoerciveOnSkewedCells)
{
  const LatticeGradient gradient = rubber_gradient(0.05);
  RectangleMesh mesh(rectangle(8, 8));
  dealii::GridTools::transform([](const Point<2> &X) { return Point<2>(X[0] + 3. * X[1], X[1]); }, mesh);
  const auto field = std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.1 * X[0], 0.2 * X[1] + 0.01 * std::sin(30. * X[0]) * std::sin(40. * X[1])});
    });
  for (const double penalty : {0., 0.5, 20.})
  {
    Constitution laws(law, gradient);
    laws.penalty = penalty;
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver solver(mesh, laws, on_all_edges(field), settings);
    EXPECT_EQ(solver.solve().load_steps.size(), 1u) << penalty;
  }
}

// Inexact linear solves: the same equilibrium at lower cost, with at most two additional Newton steps, of which the
// last are as large as exact steps.
TEST(GradientEquilibrium, InexactStepsEndAtTheSameEquilibrium)
{
  const IsotropicGradient gradient(5e5, 0.1 * height);
  struct Answer
  {
    double energy;
    std::vector<PointState> states;
    std::size_t n_steps;
    unsigned int n_linear;
  };
  const auto solve = [&](const double largest_forcing)
  {
    RectangleMesh mesh(rectangle(12, 8));
    StaticSettings settings;
    settings.degree = 2;
    settings.linear.direct_limit = 0;
    settings.linear.coarsest_size = 150;
    settings.largest_forcing = largest_forcing;
    StaticSolver solver(mesh, Constitution(law, gradient), clamped_bump(1.5, 1.8, 0.02), settings);
    const SolverReport report = solver.solve();
    EXPECT_LE(report.iterations.back().residual, report.iterations.back().tolerance);
    EXPECT_LE(most_linear_iterations(report), 17u); // measured: 16
    unsigned int n_linear = 0;
    for (const auto &iteration : report.iterations)
      n_linear += iteration.linear_iterations;
    return Answer{solver.total_energy(), solver.sheet().evaluate(solver.displacement(), scattered_points(7, 5)),
                  report.iterations.size(), n_linear};
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

// At parts of the load, with a prescribed normal gradient, on which the stiffness of a nonlinear law depends.
TEST(GradientEquilibrium, NewtonIsQuadraticInEveryLoadStep)
{
  const LatticeGradient gradient = rubber_gradient(0.02);
  RectangleMesh mesh(rectangle(6, 4));
  BoundaryConditions conditions(bump_problem(1.5, 1.5, 0.));
  conditions.normal_gradients.push_back({edge::top, std::make_shared<Field>(
                                                      [](const Point<2> &X) {
                                                        return Tensor<1, 2>({X[0], 0.8});
                                                      })});
  StaticSettings settings;
  settings.degree = 2;
  settings.first_load_step = 0.25;
  StaticSolver solver(mesh, Constitution(law, gradient), conditions, settings);
  const std::vector<NewtonIteration> all = solver.solve().iterations;
  EXPECT_LT(all[0].load_factor, 1.);
  EXPECT_GE(newton_order(all, 0), 1.8);
}

// (1 - l^2 Laplace) multiplies a sinusoidal force of wave number k by 1 + l^2 k^2 for every shape function; the
// boundary integral compensates the partial integration. theory-continuum.md, eq. (C.32).
TEST(GradientEquilibrium, CorrectsTheBodyForceOfMicroInertia)
{
  RectangleMesh mesh(rectangle(12, 8));
  const double k = 40.;
  const auto force = std::make_shared<dealii::FunctionParser<2>>(2, 0., 1e-4);
  force->set_formula(dealii::AutoDerivativeFunction<2>::FourthOrder);
  force->initialize("x,y", std::vector<std::string>{"1e5*sin(40*(0.6*x+0.8*y)+0.3)", "2e5*cos(40*(0.8*x-0.6*y))"}, {});
  const auto loads = [&](const double with_length)
  {
    BoundaryConditions conditions(on_all_edges(affine(matrix(1., 0., 0., 1.))));
    conditions.body_force = BodyForce{force, with_length};
    return Sheet(mesh, law, 3, conditions).loads();
  };
  Sheet::Vector plain = loads(0.);
  Sheet::Vector corrected = loads(0.02);
  plain *= 1. + std::pow(0.02 * k, 2);
  corrected -= plain;
  // Gauss quadrature of degree 9 on cells of half a radian, and fourth-order differences: both errors are below 1e-8.
  EXPECT_LT(corrected.linfty_norm(), 1e-7 * plain.linfty_norm());
}

// Law that vanishes at F = I and not under strain.
class StiffeningGradient : public IsotropicGradient
{
public:
  using IsotropicGradient::IsotropicGradient;
  GradientResponse evaluate(const Tensor<2, 2> &F, const Gradient &G, const Order order) const override
  {
    GradientResponse W = IsotropicGradient::evaluate(F, G, order);
    W.double_stress_by_G *= (F - identity).norm();
    return W;
  }
};

// Without a gradient energy, normal gradients cannot be prescribed and double tractions do no work. A law without
// stiffness at F = I is one.
TEST(GradientEquilibrium, RefusesImpossibleInput)
{
  const IsotropicGradient gradient(5e5, internal_length), zero(5e5, 0.);
  RectangleMesh mesh(rectangle(2, 2));
  const auto field = affine(matrix(1., 0., 0., 1.));
  BoundaryConditions conditions(on_all_edges(field));
  BoundaryConditions held = conditions, loaded = conditions, without_edge = conditions, wrong_force = conditions;
  held.normal_gradients.push_back({edge::top, field});
  loaded.double_tractions.push_back({edge::top, field});
  for (const BoundaryConditions &impossible : {held, loaded})
  {
    EXPECT_THROW(StaticSolver(mesh, law, impossible), InvalidInput);
    EXPECT_THROW(StaticSolver(mesh, Constitution(law, zero), impossible), InvalidInput);
    EXPECT_NO_THROW(StaticSolver(mesh, Constitution(law, gradient), impossible));
  }
  const StiffeningGradient stiffening(5e5, internal_length);
  EXPECT_EQ(stiffening.normal_stiffness(), 0.);
  EXPECT_NO_THROW(StaticSolver(mesh, Constitution(law, stiffening), held));
  without_edge.normal_gradients = {{9, field}};
  wrong_force.body_force = BodyForce{field, -1.};
  for (const BoundaryConditions &impossible : {without_edge, wrong_force})
    EXPECT_THROW(StaticSolver(mesh, Constitution(law, gradient), impossible), InvalidInput);
  StaticSettings linear;
  linear.degree = 1;
  EXPECT_THROW(StaticSolver(mesh, Constitution(law, gradient), conditions, linear), InvalidInput);
  Constitution constitution(law, gradient);
  constitution.penalty = -1.;
  EXPECT_THROW(StaticSolver(mesh, constitution, conditions), InvalidInput);
}

} // namespace gradient_solver_test
