// Gradient part of the viscosity of dashpots at a point, compared with differences and with sums over bonds.
#include "continuum/errors.h"
#include "continuum/rate_forces.h"
#include "sheets.h"
#include "support/largest_error.h"

#include <deal.II/base/quadrature_lib.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gradient_viscosity_test
{
using namespace sheets;
using namespace latcon::continuum;

constexpr double spacing = 0.2; // [m]
constexpr double micro_length = 0.6 * spacing;

// Dashpots along the bonds of rubber_network, of another viscosity in either shell.
std::vector<FibreDashpot> dashpots()
{
  std::vector<FibreDashpot> all;
  for (const BondFamily &bond : rubber_bonds(spacing))
    all.push_back({bond.fibre.direction, bond.fibre.weight, bond.length > spacing ? 250. : 400., bond.length});
  return all;
}

// The law of these dashpots, with its gradient part.
const FibreViscosity &viscosity()
{
  static const FibreViscosity law(dashpots(), micro_length);
  return law;
}

double entry(std::mt19937 &generator)
{
  return std::uniform_real_distribution<double>(-1., 1.)(generator);
}

// Derivatives of a displacement, of the size of 1 and, by the second ones, 1 per spacing.
FieldDerivatives random_derivatives(std::mt19937 &generator, const double size)
{
  FieldDerivatives all;
  for (ComponentDerivatives &component : all)
    for (unsigned int c = 0; c < n_derivatives; ++c)
      component[c] = size * entry(generator) / (c < n_first ? 1. : spacing);
  return all;
}

Tensor<1, 2> random_normal(std::mt19937 &generator)
{
  const double angle = pi * entry(generator);
  return Tensor<1, 2>({std::cos(angle), std::sin(angle)});
}

// Stretch of a fibre with direction N at X = s M and time t, of the sheet with u + t v.
double stretch(const FieldDerivatives &u, const FieldDerivatives &v, const Tensor<1, 2> &N, const Tensor<1, 2> &M,
               const double s, const double t)
{
  Tensor<1, 2> f = N;
  for (unsigned int i = 0; i < 2; ++i)
  {
    const auto at = [&](const unsigned int c) { return u[i][c] + t * v[i][c]; };
    f[i] += (at(0) + s * (at(2) * M[0] + at(4) * M[1])) * N[0] + (at(1) + s * (at(4) * M[0] + at(3) * M[1])) * N[1];
  }
  return f.norm();
}

// theory-continuum.md, eq. (C.61).
TEST(GradientViscosity, DissipatesTheRatesOfTheGradientsOfStretches)
{
  const Viscosity &law = *viscosity().gradient();
  std::mt19937 generator(31);
  for (int sample = 0; sample < 20; ++sample)
  {
    const FieldDerivatives u = random_derivatives(generator, 0.2);
    const FieldDerivatives v = random_derivatives(generator, 3.);
    double expected = 0.;
    for (const FibreDashpot &dashpot : dashpots())
    {
      const auto &N = dashpot.direction;
      const auto rate = [&](const Tensor<1, 2> &M)
      {
        const double s = 1e-4 * spacing;
        const double t = 1e-4;
        return (stretch(u, v, N, M, s, t) - stretch(u, v, N, M, -s, t) - stretch(u, v, N, M, s, -t) +
                stretch(u, v, N, M, -s, -t)) /
               (4. * s * t);
      };
      const double l_d2 = micro_length * micro_length;
      expected += dashpot.weight * dashpot.viscosity *
                  (l_d2 * std::pow(rate(Tensor<1, 2>({-N[1], N[0]})), 2) +
                   (l_d2 - dashpot.length * dashpot.length / 12.) * std::pow(rate(N), 2));
    }
    PointIntegrand density;
    clear(density, Order::value);
    law.add_density(u, v, Order::value, 0., density);
    // Differences over 1e-4 have errors of 1e-8, and round-off of 1e-16/1e-8.
    EXPECT_NEAR(density.value, expected, 1e-5 * expected);
  }
}

// Dissipation of a wave v = p cos(K.X) on a homogeneous sheet, times 1 + l_d^2 k^2, as a sum over bonds: to fourth
// order that of the local and the gradient viscosity. theory-continuum.md, eqs. (C.60) and (C.62).
TEST(GradientViscosity, HasTheBondsDampingOfLongWavesToFourthOrder)
{
  std::mt19937 generator(32);
  for (int sample = 0; sample < 10; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Tensor<1, 2> direction = random_normal(generator);
    const Tensor<1, 2> p = random_normal(generator);
    const FieldDerivatives state = field_derivatives(F);
    const auto error = [&](const double kd)
    {
      const Tensor<1, 2> K = kd / spacing * direction;
      double bonds = 0.;
      for (const FibreDashpot &dashpot : dashpots())
      {
        const Tensor<1, 2> f = F * dashpot.direction;
        const double l = dashpot.length;
        bonds += dashpot.weight * dashpot.viscosity * 4. *
                 std::pow(std::sin(0.5 * l * (K * dashpot.direction)) / l, 2) * std::pow(f * p / f.norm(), 2);
      }
      // The amplitudes: F' = -p K sin, G' = -p K K cos.
      FieldDerivatives first{}, second{};
      for (unsigned int i = 0; i < 2; ++i)
      {
        first[i] = {p[i] * K[0], p[i] * K[1]};
        second[i] = {0., 0., p[i] * K[0] * K[0], p[i] * K[1] * K[1], p[i] * K[0] * K[1]};
      }
      PointIntegrand density;
      clear(density, Order::value);
      viscosity().add_density(state, first, Order::value, 0., density);
      viscosity().gradient()->add_density(state, second, Order::value, 0., density);
      return std::abs(density.value / (bonds * (1. + micro_length * micro_length * K.norm_square())) - 1.);
    };
    // The next term is of the order of (k l)^2/30 of the error.
    EXPECT_NEAR(std::log2(error(0.2) / error(0.1)), 4., 0.05);
  }
}

// First and second derivatives of the density, compared with differences of value and first. theory-continuum.md, eq.
// (C.61).
TEST(GradientViscosity, HasTheDerivativesOfItsDensity)
{
  const Viscosity &law = *viscosity().gradient();
  constexpr double rate_by_displacement = 20.;
  const auto density = [&](const FieldDerivatives &at_u, const FieldDerivatives &at_v, const Order order)
  {
    PointIntegrand d;
    clear(d, order);
    law.add_density(at_u, at_v, order, rate_by_displacement, d);
    return d;
  };
  std::mt19937 generator(33);
  for (int sample = 0; sample < 5; ++sample)
  {
    const FieldDerivatives u = random_derivatives(generator, 0.2), v = random_derivatives(generator, 3.);
    const PointIntegrand d = density(u, v, Order::second);
    const PointIntegrand first = density(u, v, Order::first);
    EXPECT_EQ(density(u, v, Order::value).value, first.value);
    support::LargestError largest_first, largest_second;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = 0; c < n_derivatives; ++c)
      {
        const double scale = c < n_first ? 1. : spacing;
        largest_first.add(std::abs(d.first[i][c]) / scale);
        largest_second.add(std::abs(d.second[i][i][c][c]) / (scale * scale));
      }
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int b = 0; b < n_derivatives; ++b)
      {
        const double scale = b < n_first ? 1. : spacing;
        const double h = 1e-5 / scale;
        FieldDerivatives up = v, down = v;
        up[k][b] += h;
        down[k][b] -= h;
        // The value is twice R, which is quadratic in v: no error but round-off.
        EXPECT_NEAR((density(u, up, Order::value).value - density(u, down, Order::value).value) / (4. * h),
                    d.first[k][b], 1e-8 * largest_first.error() * scale)
          << k << b;
        FieldDerivatives u_up = u, u_down = u;
        u_up[k][b] += h;
        u_down[k][b] -= h;
        up[k][b] = v[k][b] + rate_by_displacement * h;
        down[k][b] = v[k][b] - rate_by_displacement * h;
        const PointIntegrand after = density(u_up, up, Order::first);
        const PointIntegrand before = density(u_down, down, Order::first);
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int c = 0; c < n_derivatives; ++c)
            EXPECT_NEAR((after.first[i][c] - before.first[i][c]) / (2. * h), d.second[i][k][c][b],
                        1e-7 * largest_second.error() * scale * (c < n_first ? 1. : spacing))
              << i << c << k << b;
      }
  }
}

// The rate of a kink, as in GradientEquilibrium.LiftsAKinkAsInClosedForm, on a stretched sheet: the gradient part
// dissipates n p^2 / 2 h times the power of the rate s e_y (x) NN per length of the column of faces.
// theory-continuum.md, eqs. (C.59) and (C.63).
TEST(GradientViscosity, DissipatesAKinkAsInClosedForm)
{
  const CauchyBorn law = rubber_network();
  const LatticeGradient gradient = rubber_gradient(spacing);
  const FibreViscosity without(dashpots());
  constexpr double h = 0.02, s = 0.3, n = 4.;
  const Tensor<2, 2> F = matrix(1.4, 0.1, 0., 1.2);
  FieldDerivatives rate{};
  rate[1][n_first] = s;
  PointIntegrand density;
  clear(density, Order::value);
  viscosity().gradient()->add_density(field_derivatives(F), rate, Order::value, 0., density);
  for (const unsigned int p : {2u, 3u})
  {
    Mesh mesh(MPI_COMM_SELF);
    make_rectangle(mesh, {4. * h, 2. * h, 4, 2, false, true});
    BoundaryConditions periodic;
    periodic.periodic = {{edge::bottom, edge::top, 1}};
    const Sheet sheet(mesh, Constitution(law, gradient), p, periodic);
    // Without constraints, which would make the stretch along Y vanish.
    const auto values = [&](const auto &field)
    {
      Sheet::Vector owned = sheet.make_owned(), ghosted = sheet.make_ghosted();
      sheet.for_each_owned_dof([&](const auto dof, const unsigned int i, const Point<2> &X)
                               { owned(dof) = field(X)[i]; });
      ghosted = owned;
      return ghosted;
    };
    const Sheet::Vector u = values([&](const Point<2> &X) { return F * X - X; });
    const Sheet::Vector v = values(
      [&](const Point<2> &X) {
        return Tensor<1, 2>({0., s * std::max(0., X[0] - 2. * h)});
      });
    const double local = RateForces(sheet, &without, nullptr).dissipation(u, v, {});
    const double expected = density.value * n * p * p / (2. * h) * 2. * h;
    EXPECT_NEAR(RateForces(sheet, &viscosity(), nullptr).dissipation(u, v, {}) - local, expected,
                1e-10 * (local + expected))
      << p;
  }
}

// A quadratic motion whose normal gradient is the prescribed one has no jumps, and the gradient part dissipates the
// power of its own second gradients. theory-continuum.md, eq. (C.63).
TEST(GradientViscosity, KnowsThePrescribedNormalGradients)
{
  const CauchyBorn law = rubber_network();
  const LatticeGradient gradient = rubber_gradient(spacing);
  Mesh mesh(MPI_COMM_SELF);
  make_rectangle(mesh, rectangle(1, 1));
  constexpr double curvature = 3., factor = 0.7, rate = 40.;
  // u = factor w and v = rate w with w = curvature X^2 / 2 along both axes.
  BoundaryConditions conditions;
  conditions.normal_gradients = {{edge::right, std::make_shared<Field>(
                                                 [](const Point<2> &X) {
                                                   return curvature * X[0] * Tensor<1, 2>({1., 1.});
                                                 })}};
  const Sheet sheet(mesh, Constitution(law, gradient), 2, conditions);
  const auto w = [](const Point<2> &X) { return 0.5 * curvature * X[0] * X[0] * Tensor<1, 2>({1., 1.}); };
  const auto u = nodal(sheet, [&](const Point<2> &X) { return factor * w(X); });
  const auto v = nodal(sheet, [&](const Point<2> &X) { return rate * w(X); });
  double expected = 0.;
  const dealii::QGauss<2> points(3);
  for (unsigned int q = 0; q < points.size(); ++q)
  {
    FieldDerivatives derivatives{}, rates{};
    for (unsigned int i = 0; i < 2; ++i)
    {
      derivatives[i] = {factor * curvature * length * points.point(q)[0], 0., factor * curvature};
      rates[i] = {rate * curvature * length * points.point(q)[0], 0., rate * curvature};
    }
    PointIntegrand density;
    clear(density, Order::value);
    viscosity().gradient()->add_density(derivatives, rates, Order::value, 0., density);
    expected += points.weight(q) * length * height * density.value;
  }
  const FibreViscosity without(dashpots());
  const double local = RateForces(sheet, &without, nullptr).dissipation(u, v, {factor, rate});
  EXPECT_NEAR(RateForces(sheet, &viscosity(), nullptr).dissipation(u, v, {factor, rate}) - local, expected,
              1e-12 * (local + expected));
}

// Nodal forces at a rough state, whose normal gradients jump, on a mesh with hanging nodes: their power is what is
// dissipated, not negative, and their derivative is the tangent. theory-continuum.md, eq. (C.63).
TEST(GradientViscosity, HasTheForcesOfTheLiftedGradients)
{
  const CauchyBorn law = rubber_network();
  const LatticeGradient gradient = rubber_gradient(spacing);
  Mesh mesh(MPI_COMM_SELF);
  make_rectangle(mesh, rectangle(2, 2));
  mesh.begin_active()->set_refine_flag();
  mesh.execute_coarsening_and_refinement();
  const Sheet sheet(mesh, Constitution(law, gradient), 2);
  const RateForces viscous(sheet, &viscosity(), nullptr);
  std::mt19937 generator(35);
  const auto random = [&](const double size)
  {
    Sheet::Vector v = sheet.make_owned();
    for (const auto i : sheet.owned())
      v(i) = size * entry(generator);
    sheet.conformity_constraints().distribute(v);
    return v;
  };
  const auto ghosted = [&](const Sheet::Vector &v)
  {
    Sheet::Vector result = sheet.make_ghosted();
    result = v;
    return result;
  };
  const auto forces = [&](const Sheet::Vector &u, const Sheet::Vector &v)
  {
    Sheet::Vector sum = sheet.make_owned();
    viscous.add_forces(0., ghosted(u), ghosted(v), {}, sum, nullptr);
    return sum;
  };
  constexpr double rate = 20., step = 1e-4;
  const Sheet::Vector u = random(2e-3), v = random(0.1), w = random(1e-3);
  const Sheet::Vector C = forces(u, v);
  const double dissipation = viscous.dissipation(ghosted(u), ghosted(v), {});
  EXPECT_GT(dissipation, 0.);
  EXPECT_NEAR(C * v, dissipation, 1e-12 * dissipation);

  Sheet::Matrix K;
  sheet.make_matrix(sheet.conformity_constraints(), K);
  K = 0.;
  viscous.add_tangent(0., ghosted(u), ghosted(v), {}, rate, sheet.conformity_constraints(), K);
  Sheet::Vector Kw = sheet.make_owned(), difference = sheet.make_owned();
  K.vmult(Kw, w);
  for (const double sign : {1., -1.})
  {
    Sheet::Vector there = u, v_there = v;
    there.add(sign * step, w);
    v_there.add(sign * step * rate, w);
    difference.add(sign / (2. * step), forces(there, v_there));
  }
  for (const auto i : sheet.owned())
    if (sheet.conformity_constraints().is_constrained(i))
      Kw(i) = difference(i) = 0.;
  difference -= Kw;
  // Differences have relative errors of the square of the step over the size of a cell, and of round-off over the step.
  EXPECT_LT(difference.l2_norm(), 1e-6 * Kw.l2_norm());
}

TEST(GradientViscosity, RefusesLengthsThatWouldNotDissipate)
{
  const double longest = std::sqrt(3.) * spacing;
  EXPECT_NO_THROW(FibreViscosity(dashpots(), longest / std::sqrt(12.)));
  EXPECT_THROW(FibreViscosity(dashpots(), 0.999 * longest / std::sqrt(12.)), InvalidMaterial);
  EXPECT_THROW(FibreViscosity(dashpots(), std::nan("")), InvalidMaterial);
  std::vector<FibreDashpot> without_length = dashpots();
  without_length.front().length = 0.;
  EXPECT_THROW(FibreViscosity(without_length, micro_length), InvalidMaterial);
  EXPECT_NO_THROW(FibreViscosity{without_length});
}
} // namespace gradient_viscosity_test
