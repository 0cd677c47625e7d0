#include "lattice/bonds/expression_law.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace latcon::lattice
{
namespace
{

using support::Expression;
using Operation = Expression::Operation;

// Nodes of an expression, without operations that change nothing.
class Builder
{
public:
  explicit Builder(Expression &expression) : e_(expression) {}

  // An operation as the loop computes it: quotients by the inverse, which terms with one denominator share, since a
  // division takes as long as several products, and powers by products. @param value of a constant, exponent of a power
  std::size_t apply(Operation operation, std::size_t a, std::size_t b = 0, double value = 0.)
  {
    switch (operation)
    {
    case Operation::variable:
      return e_.variable();
    case Operation::constant:
      return number(value);
    case Operation::add:
      return e_.is_constant(a, 0.) ? b : e_.is_constant(b, 0.) ? a : e_.apply(operation, a, b);
    case Operation::subtract:
      if (e_.is_constant(a, 0.))
        return apply(Operation::multiply, number(-1.), b);
      return e_.is_constant(b, 0.) ? a : e_.apply(operation, a, b);
    case Operation::multiply:
      if (e_.is_constant(a, 0.) || e_.is_constant(b, 0.))
        return number(0.);
      return e_.is_constant(a, 1.) ? b : e_.is_constant(b, 1.) ? a : e_.apply(operation, a, b);
    case Operation::divide:
      return apply(Operation::multiply, a, inverse(b));
    case Operation::power:
      return power(a, value);
    default:
      return e_.apply(operation, a);
    }
  }

  std::size_t number(double value) { return e_.constant(value); }
  std::size_t inverse(std::size_t a) { return e_.apply(Operation::divide, number(1.), a); }

  std::size_t power(std::size_t a, double exponent)
  {
    constexpr double largest_product = 64.;
    if (exponent == 0.)
      return number(1.);
    if (exponent == 0.5)
      return e_.apply(Operation::square_root, a);
    if (exponent != std::round(exponent) || std::abs(exponent) > largest_product)
      return e_.power(a, number(exponent));
    return whole_power(exponent < 0. ? inverse(a) : a, static_cast<unsigned int>(std::abs(exponent)));
  }

private:
  std::size_t whole_power(std::size_t a, unsigned int exponent)
  {
    if (exponent == 1)
      return a;
    const std::size_t half = whole_power(a, exponent / 2), square = apply(Operation::multiply, half, half);
    return exponent % 2 == 0 ? square : apply(Operation::multiply, square, a);
  }

  Expression &e_;
};

// Copies the operations that a function needs, as the loop computes them.
Expression lowered(const Expression &function)
{
  const std::vector<Expression::Node> &nodes = function.nodes();
  std::vector<bool> needed(nodes.size(), false);
  needed[function.result] = true;
  for (std::size_t i = nodes.size(); i-- > 0;)
    if (needed[i])
      needed[nodes[i].left] = needed[nodes[i].right] = true;
  Expression result;
  Builder b(result);
  std::vector<std::size_t> copy(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (needed[i])
      copy[i] = b.apply(nodes[i].operation, copy[nodes[i].left], copy[nodes[i].right], nodes[i].value);
  result.result = copy[function.result];
  return result;
}

// Derivative by the variable.
Expression derivative(const Expression &function)
{
  Expression result = function;
  Builder b(result);
  const auto product = [&](std::size_t a, std::size_t c) { return b.apply(Operation::multiply, a, c); };
  std::vector<std::size_t> slope;
  const auto slope_of = [&](std::size_t i)
  {
    const auto [operation, value, left, right] = function.nodes()[i];
    switch (operation)
    {
    case Operation::variable:
      return b.number(1.);
    case Operation::constant:
      return b.number(0.);
    case Operation::add:
    case Operation::subtract:
      return b.apply(operation, slope[left], slope[right]);
    case Operation::multiply:
      return b.apply(Operation::add, product(slope[left], right), product(left, slope[right]));
    case Operation::divide:
      return b.apply(operation, b.apply(Operation::subtract, slope[left], product(i, slope[right])), right);
    case Operation::power:
      return product(product(b.number(value), b.power(left, value - 1.)), slope[left]);
    case Operation::square_root:
      return b.apply(Operation::divide, slope[left], product(b.number(2.), i));
    case Operation::exponential:
      return product(i, slope[left]);
    case Operation::logarithm:
      return b.apply(Operation::divide, slope[left], left);
    }
    throw std::logic_error("an operation without a derivative");
  };
  for (std::size_t i = 0; i < function.nodes().size(); ++i)
    slope.push_back(slope_of(i));
  result.result = slope[function.result];
  return result;
}

// Values of a function at n stretches, operation by operation.
template <std::size_t n>
void run(const Expression &function, const double *stretches, double *values)
{
  alignas(64) double of_nodes[Expression::max_nodes][n];
  double *to = of_nodes[0];
  for (const auto &[operation, value, left_node, right_node] : function.nodes())
  {
    const double *const left = of_nodes[left_node], *const right = of_nodes[right_node];
    switch (operation)
    {
    case Operation::variable:
      std::copy_n(stretches, n, to);
      break;
    case Operation::constant:
      std::fill_n(to, n, value);
      break;
    case Operation::add:
      std::transform(left, left + n, right, to, std::plus());
      break;
    case Operation::subtract:
      std::transform(left, left + n, right, to, std::minus());
      break;
    case Operation::multiply:
      std::transform(left, left + n, right, to, std::multiplies());
      break;
    case Operation::divide:
      std::transform(left, left + n, right, to, std::divides());
      break;
    case Operation::square_root:
      std::transform(left, left + n, to, [](double a) { return std::sqrt(a); });
      break;
    default:
      for (std::size_t i = 0; i < n; ++i)
        to[i] = support::evaluate(operation, value, left[i], 0.);
    }
    to += n;
  }
  std::copy_n(of_nodes[function.result], n, values);
}

} // namespace

ExpressionLaw::ExpressionLaw(Expression psi, double longest) : psi_(std::move(psi))
{
  const Expression force = derivative(psi_);
  energy_ = lowered(psi_);
  force_ = lowered(force);
  stiffness_ = lowered(derivative(force));
  at_rest_ = at(energy_, 1.);
  check(longest);
}

double ExpressionLaw::at(const Expression &function, double stretch) noexcept
{
  double value;
  run<1>(function, &stretch, &value);
  return value;
}

void ExpressionLaw::forces(std::size_t n, const double *stretches, double *forces) const noexcept
{
  if (n == 8)
    run<8>(force_, stretches, forces);
  else if (n == 4)
    run<4>(force_, stretches, forces);
  else if (n == 2)
    run<2>(force_, stretches, forces);
  else
    CustomBondLaw::forces(n, stretches, forces);
}

} // namespace latcon::lattice
