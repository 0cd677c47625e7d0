// Dashpots of a network: stress and its derivatives, compared with automatic differentiation, and dissipation.
#include "continuum/errors.h"
#include "continuum/viscosity.h"
#include "sheets.h"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace viscosity_test
{

using namespace latcon;
using namespace sheets;
using continuum::FibreDashpot;
using continuum::FibreViscosity;

const double epsilon = std::numeric_limits<double>::epsilon();

FibreViscosity mixed_dashpots()
{
  return FibreViscosity({{Tensor<1, 2>({1., 0.}), 0.7, 60.},
                         {Tensor<1, 2>({0.6, 0.8}), 1.1, 200.},
                         {Tensor<1, 2>({-0.28, 0.96}), 0.4, 0.}});
}

// Density in the state F with the rate Fdot.
continuum::PointIntegrand density(const FibreViscosity &law, const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot,
                                  const continuum::Order order, const double rate_by_displacement = 0.)
{
  continuum::PointIntegrand result;
  continuum::clear(result, order);
  law.add_density(continuum::field_derivatives(F), continuum::field_derivatives(matrix(1., 0., 0., 1.) + Fdot), order,
                  rate_by_displacement, result);
  return result;
}

Tensor<2, 2> random_rate(std::mt19937 &generator)
{
  std::uniform_real_distribution<double> entry(-3., 3.);
  return matrix(entry(generator), entry(generator), entry(generator), entry(generator));
}

// Sum of c eta of all dashpots [Pa s].
double viscosity_of(const FibreViscosity &law)
{
  double sum = 0.;
  for (const FibreDashpot &dashpot : law.dashpots())
    sum += dashpot.weight * dashpot.viscosity;
  return sum;
}

using Fad = Sacado::Fad::DFad<double>;
constexpr unsigned int n_variables = 8; // F_11, F_12, F_21, F_22, then Fdot likewise

// Independent implementation of the stress: rate of l from l dl/dt = (F N).(Fdot N).
std::array<Fad, 4> differentiable_stress(const FibreViscosity &law, const std::array<Fad, n_variables> &z)
{
  std::array<Fad, 4> P;
  P.fill(Fad(0.));
  for (const FibreDashpot &dashpot : law.dashpots())
  {
    const auto &N = dashpot.direction;
    const Fad f[2] = {z[0] * N[0] + z[1] * N[1], z[2] * N[0] + z[3] * N[1]};
    const Fad g[2] = {z[4] * N[0] + z[5] * N[1], z[6] * N[0] + z[7] * N[1]};
    const Fad square = f[0] * f[0] + f[1] * f[1];
    const Fad tension = dashpot.weight * dashpot.viscosity * (f[0] * g[0] + f[1] * g[1]) / square; // over l
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        P[2 * i + J] += tension * f[i] * N[J];
  }
  return P;
}

// theory-continuum.md, eqs. (C.41) and (C.42).
TEST(Viscosity, AgreesWithDifferentiatedStress)
{
  const FibreViscosity law = mixed_dashpots();
  std::mt19937 generator(21);
  for (int sample = 0; sample < 100; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Tensor<2, 2> Fdot = random_rate(generator);
    std::array<Fad, n_variables> z;
    for (unsigned int i = 0; i < 4; ++i)
    {
      z[i] = Fad(n_variables, i, F[i / 2][i % 2]);
      z[4 + i] = Fad(n_variables, 4 + i, Fdot[i / 2][i % 2]);
    }
    const auto P = differentiable_stress(law, z);
    constexpr double rate_by_displacement = 20.;
    const auto found = density(law, F, Fdot, continuum::Order::first);
    const auto derivatives = density(law, F, Fdot, continuum::Order::second, rate_by_displacement);
    // Both sides add tens of terms: 100 rounding errors of their size, which is that of eta and of eta Fdot / l with
    // stretches l of at least 0.7.
    const double tolerance = 100. * epsilon * viscosity_of(law);
    const double rate = Fdot.norm() / 0.7;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        EXPECT_NEAR(found.first[i][J], P[2 * i + J].val(), tolerance * Fdot.norm());
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            EXPECT_NEAR(derivatives.second[i][k][J][L],
                        P[2 * i + J].dx(2 * k + L) + rate_by_displacement * P[2 * i + J].dx(4 + 2 * k + L),
                        tolerance * (rate + rate_by_displacement));
      }
  }
}

TEST(Viscosity, DissipatesWhatItsDashpotsDo)
{
  const FibreViscosity law = mixed_dashpots();
  std::mt19937 generator(24);
  for (int sample = 0; sample < 100; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Tensor<2, 2> Fdot = random_rate(generator);
    double power = 0.;
    for (const FibreDashpot &dashpot : law.dashpots())
    {
      const Tensor<1, 2> f = F * dashpot.direction;
      const double rate = (f * (Fdot * dashpot.direction)) / f.norm();
      power += dashpot.weight * dashpot.viscosity * rate * rate;
    }
    const double found = density(law, F, Fdot, continuum::Order::value).value;
    EXPECT_GE(found, 0.);
    EXPECT_NEAR(found, power, 100. * epsilon * viscosity_of(law) * Fdot.norm_square());
  }
}

TEST(Viscosity, RefusesWhatIsNoDashpotOrNoState)
{
  const Tensor<1, 2> x({1., 0.});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FibreViscosity({}), continuum::InvalidMaterial);
  EXPECT_THROW(FibreViscosity({{Tensor<1, 2>({1., 1.}), 1., 1.}}), continuum::InvalidMaterial);
  for (const double weight : {0., -1., nan})
    EXPECT_THROW(FibreViscosity({{x, weight, 1.}}), continuum::InvalidMaterial);
  for (const double viscosity : {-1., nan})
    EXPECT_THROW(FibreViscosity({{x, 1., viscosity}}), continuum::InvalidMaterial);

  const FibreViscosity law = mixed_dashpots();
  for (const Tensor<2, 2> &F : {matrix(1., 0., 0., -1.25), matrix(nan, 0., 0., 1.), Tensor<2, 2>()})
    EXPECT_THROW(density(law, F, Tensor<2, 2>(), continuum::Order::value), continuum::NonPhysicalState);
}

} // namespace viscosity_test
