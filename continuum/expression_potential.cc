#include "continuum/expression_potential.h"

#include <boost/math/differentiation/autodiff.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace latcon::continuum
{
namespace
{
// A number with its first four derivatives by the stretch.
using Jet = boost::math::differentiation::autodiff_fvar<double, 4>;

// Whole powers exist also where a = 0.
Jet power(const Jet &a, const double p)
{
  constexpr double largest_product = 64.;
  if (p != std::floor(p) || std::abs(p) > largest_product)
    return pow(a, p);
  Jet y = 1.;
  for (double done = 0.; done < std::abs(p); done += 1.)
    y *= a;
  return p < 0. ? 1. / y : y;
}

Jet jet(const support::Expression &expression, const double l)
{
  using Operation = support::Expression::Operation;
  std::vector<Jet> all;
  all.reserve(expression.nodes().size());
  for (const auto &[operation, value, left, right] : expression.nodes())
    if (operation == Operation::variable)
      all.push_back(boost::math::differentiation::make_fvar<double, 4>(l));
    else if (operation == Operation::constant)
      all.push_back(value);
    else if (operation == Operation::power)
      all.push_back(power(all[left], value));
    else
      all.push_back(support::evaluate(operation, value, all[left], all[right]));
  return all[expression.result];
}
} // namespace

ExpressionPotential::ExpressionPotential(support::Expression psi)
  : psi_(std::move(psi)), at_rest_(jet(psi_, 1.).derivative(0))
{
}

PotentialDerivatives ExpressionPotential::derivatives(const double l) const
{
  const Jet psi = jet(psi_, l);
  return {psi.derivative(0) - at_rest_, psi.derivative(1), psi.derivative(2), psi.derivative(3), psi.derivative(4)};
}
} // namespace latcon::continuum
