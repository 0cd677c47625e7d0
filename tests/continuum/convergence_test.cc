// Manufactured solutions at finite strain: the errors of the displacement and its first and second derivatives converge
// with the orders of C0 interior penalty elements. If LATCON_TABLES is set to a folder, every series of three meshes is
// also written there as CSV.
#include "manufactured.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iomanip>

namespace convergence_test
{

using namespace latcon;
using namespace sheets;
using continuum::BoundaryConditions;
using continuum::Constitution;
using continuum::StaticSettings;
using continuum::StaticSolver;
using manufactured::Forces;
using manufactured::Solution;

constexpr double gradient_length = 0.1; // of the unit square; every mesh but the coarsest resolves it

struct Errors
{
  double h;
  double u, gradient, hessian; // L2 norms, the last one over cells
};

Errors errors(const StaticSolver &solver, const Solution &exact)
{
  const continuum::Sheet &sheet = solver.sheet();
  dealii::FEValues<2> values(sheet.mapping(), sheet.element(), dealii::QGauss<2>(sheet.degree() + 3),
                             dealii::update_values | dealii::update_gradients | dealii::update_hessians |
                               dealii::update_quadrature_points | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector displacement(0);
  std::vector<Tensor<1, 2>> u(values.n_quadrature_points);
  std::vector<Tensor<2, 2>> gradient(values.n_quadrature_points);
  std::vector<Tensor<3, 2>> hessian(values.n_quadrature_points);
  Errors sums{0., 0., 0., 0.};
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
  {
    sums.h = std::max(sums.h, cell->diameter() / std::sqrt(2.));
    values.reinit(cell);
    values[displacement].get_function_values(solver.displacement(), u);
    values[displacement].get_function_gradients(solver.displacement(), gradient);
    values[displacement].get_function_hessians(solver.displacement(), hessian);
    for (unsigned int q = 0; q < u.size(); ++q)
    {
      const std::array<double, 2> X = {values.quadrature_point(q)[0], values.quadrature_point(q)[1]};
      for (unsigned int i = 0; i < 2; ++i)
      {
        sums.u += std::pow(u[q][i] - exact.value(i, X), 2) * values.JxW(q);
        for (unsigned int J = 0; J < 2; ++J)
        {
          sums.gradient += std::pow(gradient[q][i][J] - exact.first(i, J, X), 2) * values.JxW(q);
          for (unsigned int K = 0; K < 2; ++K)
            sums.hessian += std::pow(hessian[q][i][J][K] - exact.second(i, J, K, X), 2) * values.JxW(q);
        }
      }
    }
  }
  return {sums.h, std::sqrt(sums.u), std::sqrt(sums.gradient), std::sqrt(sums.hessian)};
}

enum class Local
{
  network,
  mooney_rivlin
};
enum class Nonlocal
{
  none,
  isotropic,
  lattice
};
enum class Meshes
{
  uniform,
  hanging
};
enum class Edges
{
  clamped,     // prescribed displacement and normal gradient
  loaded_above // traction and double traction on the upper edge
};

struct Series
{
  Local local;
  Nonlocal nonlocal;
  Meshes meshes;
  Edges edges;
  unsigned int degree;

  std::string name() const
  {
    return std::string(local == Local::network ? "network" : "mooney_rivlin") +
           (nonlocal == Nonlocal::none        ? "_local"
            : nonlocal == Nonlocal::isotropic ? "_isotropic"
                                              : "_lattice") +
           (meshes == Meshes::uniform ? "_uniform" : "_hanging") + (edges == Edges::clamped ? "" : "_loaded") + "_p" +
           std::to_string(degree);
  }
};

// Makes a mesh of the unit square with cells of side 2^-level; for hanging nodes, refines a disc in the middle once
// more.
void make_mesh(Mesh &mesh, const unsigned int level, const Meshes meshes)
{
  dealii::GridGenerator::hyper_cube(mesh, 0., 1., true);
  mesh.refine_global(2);
  if (meshes == Meshes::hanging)
  {
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->center().distance(Point<2>(0.5, 0.5)) < 0.3)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
  mesh.refine_global(level - 2);
}

std::vector<Errors> run(const Series &series, const unsigned int n_meshes)
{
  const continuum::CauchyBorn network = rubber_network();
  const continuum::MooneyRivlin mooney_rivlin = rubber_sheet();
  const auto bonds = rubber_bonds(2. * gradient_length); // l_d is half the spacing
  const continuum::LatticeGradient lattice = rubber_gradient(2. * gradient_length);
  const continuum::IsotropicGradient isotropic(5e5, gradient_length);

  Forces::EnergyFunction local, nonlocal;
  if (series.local == Local::network)
    local = energies::NetworkEnergy{network.families()};
  else
    local = energies::MooneyRivlinEnergy{mooney_rivlin.constants()};
  Constitution constitution(network);
  if (series.local != Local::network)
    constitution.local = &mooney_rivlin;
  if (series.nonlocal == Nonlocal::isotropic)
  {
    constitution.gradient = &isotropic;
    nonlocal = energies::IsotropicGradientEnergy{5e5 * gradient_length * gradient_length};
  }
  if (series.nonlocal == Nonlocal::lattice)
  {
    constitution.gradient = &lattice;
    nonlocal = energies::LatticeGradientEnergy{bonds, gradient_length};
  }
  const auto forces = std::make_shared<Forces>(
    [local, nonlocal](const energies::Variables<manufactured::Energy> &v)
    {
      manufactured::Energy W = local(v);
      if (nonlocal)
        W += nonlocal(v);
      return W;
    });
  const Solution &exact = forces->solution();

  BoundaryConditions conditions;
  conditions.body_force =
    continuum::BodyForce{std::make_shared<Field>([forces](const Point<2> &X) { return forces->body(X); }), 0.};
  const auto displacement = std::make_shared<Field>(
    [exact](const Point<2> &X)
    {
      const std::array<double, 2> at = {X[0], X[1]};
      return Tensor<1, 2>({exact.value(0, at), exact.value(1, at)});
    });
  for (const auto id : {continuum::edge::left, continuum::edge::right, continuum::edge::bottom, continuum::edge::top})
  {
    const Tensor<1, 2> N = id == continuum::edge::left     ? Tensor<1, 2>({-1., 0.})
                           : id == continuum::edge::right  ? Tensor<1, 2>({1., 0.})
                           : id == continuum::edge::bottom ? Tensor<1, 2>({0., -1.})
                                                           : Tensor<1, 2>({0., 1.});
    if (id == continuum::edge::top && series.edges == Edges::loaded_above)
    {
      conditions.tractions.push_back(
        {id, std::make_shared<Field>([forces, N](const Point<2> &X) { return forces->traction(X, N); })});
      conditions.double_tractions.push_back(
        {id, std::make_shared<Field>([forces, N](const Point<2> &X) { return forces->double_traction(X, N); })});
      continue;
    }
    conditions.displacements.push_back({id, displacement});
    if (series.nonlocal != Nonlocal::none)
      conditions.normal_gradients.push_back({id, std::make_shared<Field>(
                                                   [exact, N](const Point<2> &X)
                                                   {
                                                     const std::array<double, 2> at = {X[0], X[1]};
                                                     Tensor<1, 2> gradient;
                                                     for (unsigned int i = 0; i < 2; ++i)
                                                       gradient[i] =
                                                         exact.first(i, 0, at) * N[0] + exact.first(i, 1, at) * N[1];
                                                     return gradient;
                                                   })});
  }

  StaticSettings settings;
  settings.degree = series.degree;
  settings.relative_tolerance = 1e-13; // so that the round-off of the residual is the tolerance
  std::vector<Errors> result;
  // Finest of three meshes: 32 cells per side for p = 2, otherwise 16.
  const unsigned int first_level = series.degree == 2 ? 3 : 2;
  for (unsigned int level = first_level; level < first_level + n_meshes; ++level)
  {
    Mesh mesh(MPI_COMM_SELF);
    make_mesh(mesh, level, series.meshes);
    StaticSolver solver(mesh, constitution, conditions, settings);
    solver.solve();
    result.push_back(errors(solver, exact));
  }

  const char *folder = std::getenv("LATCON_TABLES");
  if (folder && n_meshes == 3)
  {
    std::ofstream table(std::string(folder) + "/" + series.name() + ".csv");
    table << "h [m],L2 [m^2],H1 [m],H2 [1]\n" << std::setprecision(17);
    for (const Errors &e : result)
      table << e.h << "," << e.u << "," << e.gradient << "," << e.hessian << "\n";
  }
  return result;
}

// Theoretical orders for a smooth solution and h < l: displacement 2 for p = 2 with a gradient law, otherwise p + 1;
// gradient p; second gradient p - 1. Measured between the two finest meshes, where higher-order terms change the order
// by less than 0.2.
void expect_orders(const Series &series, const unsigned int n_meshes)
{
  const std::vector<Errors> e = run(series, n_meshes);
  const Errors &coarse = e[e.size() - 2];
  const Errors &fine = e.back();
  const double p = series.degree;
  const double u_order = p == 2. && series.nonlocal != Nonlocal::none ? 2. : p + 1.;
  const auto order = [](const double a, const double b) { return std::log2(a / b); };
  EXPECT_NEAR(order(coarse.u, fine.u), u_order, 0.2) << coarse.u << " " << fine.u;
  EXPECT_NEAR(order(coarse.gradient, fine.gradient), p, 0.2) << coarse.gradient << " " << fine.gradient;
  EXPECT_NEAR(order(coarse.hessian, fine.hessian), p - 1., 0.2) << coarse.hessian << " " << fine.hessian;
}

using Convergence = testing::TestWithParam<Series>;
using CoarseConvergence = testing::TestWithParam<Series>;

// theory-continuum.md, eqs. (C.28) and (C.31).
TEST_P(Convergence, HasTheOrdersOfInteriorPenaltyElements)
{
  expect_orders(GetParam(), 3);
}

// Two meshes are in the asymptotic range as well.
TEST_P(CoarseConvergence, HasTheOrdersOfInteriorPenaltyElements)
{
  expect_orders(GetParam(), 2);
}

std::vector<Series> all_series()
{
  std::vector<Series> series;
  for (const Local local : {Local::network, Local::mooney_rivlin})
    for (const Nonlocal nonlocal : {Nonlocal::none, Nonlocal::isotropic, Nonlocal::lattice})
      for (const Meshes meshes : {Meshes::uniform, Meshes::hanging})
        for (const unsigned int degree : {2u, 3u, 4u})
          series.push_back({local, nonlocal, meshes, Edges::clamped, degree});
  for (const Nonlocal nonlocal : {Nonlocal::isotropic, Nonlocal::lattice})
    for (const unsigned int degree : {2u, 3u, 4u})
      series.push_back({Local::network, nonlocal, Meshes::uniform, Edges::loaded_above, degree});
  return series;
}

// Meshes with hanging nodes have the faces of uniform ones too. Degree 4, whose forcing takes the longest, without a
// gradient law; of the two local laws, whose tangents alone differ, one with gradient laws.
std::vector<Series> quick_series()
{
  return {{Local::network, Nonlocal::none, Meshes::hanging, Edges::clamped, 2},
          {Local::network, Nonlocal::none, Meshes::hanging, Edges::clamped, 3},
          {Local::network, Nonlocal::none, Meshes::uniform, Edges::clamped, 4},
          {Local::mooney_rivlin, Nonlocal::none, Meshes::uniform, Edges::clamped, 2},
          {Local::network, Nonlocal::isotropic, Meshes::hanging, Edges::clamped, 2},
          {Local::network, Nonlocal::isotropic, Meshes::hanging, Edges::clamped, 3},
          {Local::network, Nonlocal::isotropic, Meshes::uniform, Edges::loaded_above, 2},
          {Local::network, Nonlocal::isotropic, Meshes::uniform, Edges::loaded_above, 3},
          {Local::network, Nonlocal::lattice, Meshes::hanging, Edges::clamped, 2},
          {Local::network, Nonlocal::lattice, Meshes::uniform, Edges::clamped, 3},
          {Local::network, Nonlocal::lattice, Meshes::uniform, Edges::loaded_above, 2}};
}

INSTANTIATE_TEST_SUITE_P(Continuum, Convergence, testing::ValuesIn(all_series()),
                         [](const auto &series) { return series.param.name(); });
INSTANTIATE_TEST_SUITE_P(Continuum, CoarseConvergence, testing::ValuesIn(quick_series()),
                         [](const auto &series) { return series.param.name(); });

} // namespace convergence_test
