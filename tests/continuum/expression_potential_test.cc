#include "continuum/expression_potential.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "continuum/isotropic_network.h"

namespace expression_potential_test
{

using namespace latcon;

using continuum::ExpressionPotential;
using continuum::FibreFamily;
using continuum::PotentialDerivatives;
using dealii::Tensor;
using support::Expression;
using Operation = Expression::Operation;

std::array<double, 5> values(const PotentialDerivatives &psi)
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

// f(l) and four derivatives by hand, of each operation that the rod lacks.
TEST(ExpressionPotential, HasTheDerivativesFoundByHand)
{
  struct Subject
  {
    std::function<std::size_t(Expression &, std::size_t)> function;
    std::function<std::array<double, 5>(double)> by_hand;
  };
  const std::vector<Subject> subjects{
    {[](Expression &e, std::size_t l) { return e.apply(Operation::square_root, l); },
     [](double l) -> std::array<double, 5>
     {
       const double r = std::sqrt(l);
       return {r - 1., 0.5 / r, -0.25 / (r * l), 0.375 / (r * l * l), -0.9375 / (r * l * l * l)};
     }},
    {[](Expression &e, std::size_t l)
     { return e.apply(Operation::exponential, e.apply(Operation::multiply, e.constant(2.), l)); },
     [](double l) -> std::array<double, 5>
     {
       const double y = std::exp(2. * l);
       return {y - std::exp(2.), 2. * y, 4. * y, 8. * y, 16. * y};
     }},
    {[](Expression &e, std::size_t l) { return e.apply(Operation::logarithm, l); },
     [](double l) -> std::array<double, 5> {
       return {std::log(l), 1. / l, -1. / (l * l), 2. / std::pow(l, 3), -6. / std::pow(l, 4)};
     }},
    {[](Expression &e, std::size_t l) { return e.power(l, e.constant(2.5)); },
     [](double l) -> std::array<double, 5>
     {
       return {std::pow(l, 2.5) - 1., 2.5 * std::pow(l, 1.5), 3.75 * std::sqrt(l), 1.875 / std::sqrt(l),
               -0.9375 * std::pow(l, -1.5)};
     }},
    {[](Expression &e, std::size_t l)
     { return e.power(e.apply(Operation::subtract, l, e.constant(1.)), e.constant(3.)); },
     [](double l) -> std::array<double, 5> {
       return {std::pow(l - 1., 3), 3. * (l - 1.) * (l - 1.), 6. * (l - 1.), 6., 0.};
     }}};
  for (std::size_t i = 0; i < subjects.size(); ++i)
  {
    Expression e;
    e.result = subjects[i].function(e, e.variable());
    const ExpressionPotential typed(e);
    for (const double l : {0.5, 1., 2.})
    {
      const auto found = values(typed.derivatives(l)), wanted = subjects[i].by_hand(l);
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], wanted[k], 1e-14 * (10. + std::abs(wanted[k]))) << i << ' ' << l << ' ' << k;
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
  Tensor<2, 2> F;
  F[0] = Tensor<1, 2>({2.3, 0.3});
  F[1] = Tensor<1, 2>({-0.1, 1.1});
  // ((p - q) / (p + q))^96 is less than the round-off of a hundred terms.
  constexpr double tolerance = 1e-13;
  EXPECT_NEAR(sampled.energy(F), closed.energy(F), tolerance * closed.energy(F));
  EXPECT_LT((sampled.first_piola_stress(F) - closed.first_piola_stress(F)).norm(),
            tolerance * closed.first_piola_stress(F).norm());
  EXPECT_LT((sampled.tangent(F) - closed.tangent(F)).norm(), tolerance * closed.tangent(F).norm());
}

} // namespace expression_potential_test
