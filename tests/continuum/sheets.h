#pragma once

// Laws, meshes and conditions for several continuum tests. SI units.

#include "continuum/cauchy_born.h"
#include "continuum/isotropic_gradient.h"
#include "continuum/lattice_gradient.h"
#include "continuum/meshes.h"
#include "continuum/mooney_rivlin.h"
#include "continuum/static_solver.h"
#include "tests/support/thrown.h"

#include <deal.II/base/function.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace sheets
{
using dealii::Point;
using dealii::Tensor;
using Mesh = dealii::parallel::distributed::Triangulation<2>;

inline const double pi = std::acos(-1.);

inline Tensor<2, 2> matrix(const double xx, const double xy, const double yx, const double yy)
{
  return Tensor<2, 2>({{xx, xy}, {yx, yy}});
}

inline Tensor<2, 2> rotation(const double angle)
{
  return matrix(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
}

/// A copy with ghost entries.
inline latcon::continuum::Sheet::Vector ghosted(const latcon::continuum::Sheet &sheet,
                                                const latcon::continuum::Sheet::Vector &owned)
{
  latcon::continuum::Sheet::Vector copy = sheet.make_ghosted();
  copy = owned;
  return copy;
}

/// A copy without ghost entries.
inline latcon::continuum::Sheet::Vector owned(const latcon::continuum::Sheet &sheet,
                                              const latcon::continuum::Sheet::Vector &u)
{
  latcon::continuum::Sheet::Vector copy = sheet.make_owned();
  copy = u;
  return copy;
}

/// Interpolates a displacement [m], a function of reference position, at the nodes of a sheet; with ghost entries.
inline latcon::continuum::Sheet::Vector nodal(const latcon::continuum::Sheet &sheet,
                                              const std::function<Tensor<1, 2>(const Point<2> &)> &field)
{
  latcon::continuum::Sheet::Vector owned = sheet.make_owned();
  sheet.for_each_owned_dof([&](const auto dof, const unsigned int component, const Point<2> &X)
                           { owned(dof) = field(X)[component]; });
  owned.compress(dealii::VectorOperation::insert);
  sheet.conformity_constraints().distribute(owned);
  return ghosted(sheet, owned);
}

/// Largest number of linear iterations in a Newton step.
inline unsigned int most_linear_iterations(const latcon::continuum::SolverReport &report)
{
  unsigned int most = 0;
  for (const latcon::continuum::NewtonIteration &iteration : report.iterations)
    most = std::max(most, iteration.linear_iterations);
  return most;
}

/// Order q of r_(k+1) = C r_k^q from three residuals of Newton's method, beginning with the one of index `first`.
inline double newton_order(const std::vector<latcon::continuum::NewtonIteration> &iterations, const std::size_t first)
{
  const auto logarithm = [&](const std::size_t k)
  { return std::log(iterations[first + k + 1].residual / iterations[first + k].residual); };
  return logarithm(1) / logarithm(0);
}

/// Returns a random second gradient G_iJK [1/m], symmetric in J and K, with entries up to 0.3 / `length` [m].
inline Tensor<3, 2> random_gradient(std::mt19937 &generator, const double length)
{
  std::uniform_real_distribution<double> entry(-0.3 / length, 0.3 / length);
  Tensor<3, 2> G;
  for (unsigned int i = 0; i < 2; ++i)
  {
    G[i][0][0] = entry(generator);
    G[i][1][1] = entry(generator);
    G[i][0][1] = G[i][1][0] = entry(generator);
  }
  return G;
}

/// Rubber of Fig. 1 of the source paper: both shells of the triangular network, area factor s = 2/3, hence weights s
/// and sqrt(3) s.
inline latcon::continuum::CauchyBorn rubber_network(const double a = 1e5, const double b = 1.5e5)
{
  const double s = 2. / 3.;
  std::vector<latcon::continuum::FibreFamily> families;
  for (int k = 0; k < 6; ++k)
    families.push_back({Tensor<1, 2>({std::cos(pi * k / 6.), std::sin(pi * k / 6.)}),
                        k % 2 == 0 ? s : std::sqrt(3.) * s, latcon::continuum::RodPotential{a, b}});
  return latcon::continuum::CauchyBorn(families);
}

/// Bonds of rubber_network, with nearest neighbours at the distance `spacing` [m].
inline std::vector<latcon::continuum::BondFamily> rubber_bonds(const double spacing)
{
  const latcon::continuum::CauchyBorn network = rubber_network();
  std::vector<latcon::continuum::BondFamily> bonds;
  for (const latcon::continuum::FibreFamily &family : network.families())
    bonds.push_back({family, (bonds.size() % 2 == 0 ? 1. : std::sqrt(3.)) * spacing});
  return bonds;
}

inline latcon::continuum::LatticeGradient rubber_gradient(const double spacing)
{
  const auto bonds = rubber_bonds(spacing);
  return latcon::continuum::LatticeGradient(bonds, latcon::continuum::LatticeGradient::smallest_length(bonds));
}

inline latcon::continuum::MooneyRivlin rubber_sheet(const double ratio = -0.05)
{
  return latcon::continuum::MooneyRivlin(
    latcon::continuum::MooneyRivlin::Constants::with_equal_lame_constants(5e5, ratio));
}

/// Returns a random deformation gradient with principal stretches from `low` to `high` and rotations on both sides.
inline Tensor<2, 2> random_deformation(std::mt19937 &generator, const double low = 0.7, const double high = 3.5)
{
  std::uniform_real_distribution<double> stretch(low, high);
  std::uniform_real_distribution<double> angle(-pi, pi);
  return rotation(angle(generator)) * matrix(stretch(generator), 0., 0., stretch(generator)) *
         rotation(angle(generator));
}

/// Displacement field defined by a lambda.
class Field : public dealii::Function<2>
{
public:
  explicit Field(std::function<Tensor<1, 2>(const Point<2> &)> field) : dealii::Function<2>(2), field_(std::move(field))
  {
  }
  double value(const Point<2> &X, const unsigned int component) const override { return field_(X)[component]; }

private:
  std::function<Tensor<1, 2>(const Point<2> &)> field_;
};

inline std::shared_ptr<Field> affine(const Tensor<2, 2> &F)
{
  return std::make_shared<Field>([F](const Point<2> &X) { return F * Tensor<1, 2>(X) - Tensor<1, 2>(X); });
}

/// Prescribes the same displacement on all four edges.
inline std::vector<latcon::continuum::BoundaryField> on_all_edges(const std::shared_ptr<Field> &field)
{
  return {{latcon::continuum::edge::left, field},
          {latcon::continuum::edge::right, field},
          {latcon::continuum::edge::bottom, field},
          {latcon::continuum::edge::top, field}};
}

/// Prescribes the stretch (stretch_x, stretch_y) on all edges of a 0.15 m x 0.1 m sheet, plus a bump of height `bump`
/// [m] of the top edge that vanishes with three derivatives at the corners, so that the solution is smooth there.
constexpr double length = 0.15;
constexpr double height = 0.1;
inline std::vector<latcon::continuum::BoundaryField> bump_problem(const double stretch_x,
                                                                           const double stretch_y, const double bump)
{
  return on_all_edges(std::make_shared<Field>(
    [=](const Point<2> &X)
    {
      const double on_top = X[1] > 0.499 * height ? std::pow(std::sin(pi * X[0] / length), 4) : 0.;
      return Tensor<1, 2>({(stretch_x - 1.) * X[0], (stretch_y - 1.) * X[1] + bump * on_top});
    }));
}

inline latcon::continuum::Rectangle rectangle(const unsigned int cells_x, const unsigned int cells_y)
{
  return {length, height, cells_x, cells_y};
}

/// Mesh of a rectangle.
struct RectangleMesh : Mesh
{
  RectangleMesh(const latcon::continuum::Rectangle &shape, const MPI_Comm communicator = MPI_COMM_SELF)
    : Mesh(communicator)
  {
    latcon::continuum::make_rectangle(*this, shape);
  }
};

/// Returns points all over the sheet that are on no cell boundary of the meshes used here.
inline std::vector<Point<2>> scattered_points(const unsigned int n_x = 23, const unsigned int n_y = 17)
{
  std::vector<Point<2>> points;
  for (unsigned int i = 0; i < n_x; ++i)
    for (unsigned int j = 0; j < n_y; ++j)
      points.emplace_back(length * (i + 0.4371) / n_x, height * ((j + 0.5613) / n_y - 0.5));
  return points;
}
} // namespace sheets
