// Potentials given by expressions, compared with the rod and with differences, and their mean over all directions.
#include "continuum/expression_potential.h"
#include "continuum/isotropic_network.h"
#include "sheets.h"

#include <gtest/gtest.h>

#include <array>

namespace expression_potential_test
{

using namespace latcon;
using namespace sheets;
using continuum::ExpressionPotential;
using continuum::FibreFamily;
using support::Expression;
using Operation = Expression::Operation;

std::array<double, 5> values(const continuum::PotentialDerivatives &psi)
{
  return {psi.value, psi.first, psi.second, psi.third, psi.fourth};
}

// a (l^2 / 2 + 1 / l) + b (l + l^-2 / 2), up to a constant.
Expression rod(double a, double b)
{
  Expression e;
  const std::size_t l = e.variable(), half = e.constant(0.5);
  const auto times = [&](std::size_t i, std::size_t j) { return e.apply(Operation::multiply, i, j); };
  const auto plus = [&](std::size_t i, std::size_t j) { return e.apply(Operation::add, i, j); };
  const std::size_t of_a = plus(times(half, e.power(l, e.constant(2.))), e.apply(Operation::divide, e.constant(1.), l));
  const std::size_t of_b = plus(l, times(half, e.power(l, e.constant(-2.))));
  e.result = plus(times(e.constant(a), of_a), times(e.constant(b), of_b));
  return e;
}

TEST(ExpressionPotential, IsTheRod)
{
  const ExpressionPotential typed(rod(2., 3.));
  for (const double l : {0.5, 1., 1.8, 3.})
  {
    const auto found = values(typed.derivatives(l)), wanted = values(derivatives(continuum::RodPotential{2., 3.}, l));
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k], wanted[k], 1e-14 * (10. + std::abs(wanted[k]))) << l << ' ' << k; // some 20 roundings
  }
}

// Each operation that the rod lacks; each derivative is that of the one before.
TEST(ExpressionPotential, HasTheDerivativesOfItsValue)
{
  struct Subject
  {
    std::size_t (*function)(Expression &, std::size_t);
    double (*value)(double);
  };
  const std::vector<Subject> subjects{
    {[](Expression &e, std::size_t l) { return e.apply(Operation::square_root, l); },
     [](double l) { return std::sqrt(l); }},
    {[](Expression &e, std::size_t l)
     { return e.apply(Operation::exponential, e.apply(Operation::multiply, e.constant(2.), l)); },
     [](double l) { return std::exp(2. * l); }},
    {[](Expression &e, std::size_t l) { return e.apply(Operation::logarithm, l); },
     [](double l) { return std::log(l); }},
    {[](Expression &e, std::size_t l) { return e.power(l, e.constant(2.5)); },
     [](double l) { return std::pow(l, 2.5); }},
    {[](Expression &e, std::size_t l)
     { return e.power(e.apply(Operation::subtract, l, e.constant(1.)), e.constant(3.)); },
     [](double l) { return std::pow(l - 1., 3); }}};
  for (const auto &[function, value] : subjects)
  {
    Expression e;
    e.result = function(e, e.variable());
    const ExpressionPotential typed(e);
    for (const double l : {0.5, 1., 2.})
    {
      constexpr double step = 1e-5;
      const auto found = values(typed.derivatives(l));
      const auto up = values(typed.derivatives(l + step)), down = values(typed.derivatives(l - step));
      EXPECT_NEAR(found[0], value(l) - value(1.), 1e-14 * (10. + std::abs(found[0])));
      for (std::size_t k = 1; k < found.size(); ++k)
        EXPECT_NEAR(found[k], (up[k - 1] - down[k - 1]) / (2. * step), 1e-7 * (1. + std::abs(found[k])))
          << l << ' ' << k;
    }
  }
}

// Families of several directions and weights; the closed form knows the rod.
TEST(IsotropicNetwork, AveragesCustomPotentialsOverAllDirections)
{
  const continuum::CustomPotential typed{std::make_shared<ExpressionPotential>(rod(2., 3.))};
  const continuum::CustomPotential other{std::make_shared<ExpressionPotential>(rod(1., 0.))};
  std::vector<FibreFamily> families{{Tensor<1, 2>({1., 0.}), 0.7, continuum::RodPotential{2., 3.}},
                                    {Tensor<1, 2>({0.6, 0.8}), 1.1, continuum::RodPotential{2., 3.}},
                                    {Tensor<1, 2>({0., 1.}), 0.5, continuum::RodPotential{1., 0.}}};
  const continuum::IsotropicNetwork closed(families);
  families[0].potential = families[1].potential = typed;
  families[2].potential = other;
  const continuum::IsotropicNetwork sampled(families);
  const Tensor<2, 2> F = matrix(2.3, 0.3, -0.1, 1.1);
  // ((p - q) / (p + q))^96 is less than the round-off of a hundred terms.
  constexpr double tolerance = 1e-13;
  EXPECT_NEAR(sampled.energy(F), closed.energy(F), tolerance * closed.energy(F));
  EXPECT_LT((sampled.first_piola_stress(F) - closed.first_piola_stress(F)).norm(),
            tolerance * closed.first_piola_stress(F).norm());
  EXPECT_LT((sampled.tangent(F) - closed.tangent(F)).norm(), tolerance * closed.tangent(F).norm());
}

} // namespace expression_potential_test
