#include "lattice/bonds/expression_law.h"

#include <array>
#include <cmath>
#include <utility>

#include "lattice/bonds/law_check.h"

namespace latcon::lattice
{
namespace
{

using support::Expression;
using Operation = Expression::Operation;

constexpr std::size_t most_stretches = CustomBond::max_bonds; // of one call

// Nodes of an expression, without operations that change nothing.
class Builder
{
public:
  explicit Builder(Expression &expression) : e_(expression) {}

  std::size_t number(double value) { return e_.constant(value); }
  std::size_t sum(std::size_t a, std::size_t b)
  {
    if (e_.is_constant(a, 0.))
      return b;
    return e_.is_constant(b, 0.) ? a : e_.apply(Operation::add, a, b);
  }
  std::size_t difference(std::size_t a, std::size_t b)
  {
    if (e_.is_constant(a, 0.))
      return product(number(-1.), b);
    return e_.is_constant(b, 0.) ? a : e_.apply(Operation::subtract, a, b);
  }
  std::size_t product(std::size_t a, std::size_t b)
  {
    if (e_.is_constant(a, 0.) || e_.is_constant(b, 0.))
      return number(0.);
    if (e_.is_constant(a, 1.))
      return b;
    return e_.is_constant(b, 1.) ? a : e_.apply(Operation::multiply, a, b);
  }
  // By the inverse, which terms with one denominator share: a division takes as long as several products.
  std::size_t quotient(std::size_t a, std::size_t b) { return product(a, inverse(b)); }
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
    const std::size_t half = whole_power(a, exponent / 2), square = product(half, half);
    return exponent % 2 == 0 ? square : product(square, a);
  }

  Expression &e_;
};

// Copies the operations that a function needs, with quotients and powers as the loop computes them.
Expression lowered(const Expression &function)
{
  Expression result;
  Builder b(result);
  std::vector<std::size_t> copy;
  for (const Expression::Node &node : function.nodes())
    switch (node.operation)
    {
    case Operation::variable:
      copy.push_back(result.variable());
      break;
    case Operation::constant:
      copy.push_back(result.constant(node.value));
      break;
    case Operation::add:
      copy.push_back(b.sum(copy[node.left], copy[node.right]));
      break;
    case Operation::subtract:
      copy.push_back(b.difference(copy[node.left], copy[node.right]));
      break;
    case Operation::multiply:
      copy.push_back(b.product(copy[node.left], copy[node.right]));
      break;
    case Operation::divide:
      copy.push_back(b.quotient(copy[node.left], copy[node.right]));
      break;
    case Operation::power:
      copy.push_back(b.power(copy[node.left], node.value));
      break;
    default:
      copy.push_back(result.apply(node.operation, copy[node.left]));
    }
  result.result = copy[function.result];
  return result;
}

// Derivative by the variable.
Expression derivative(const Expression &function)
{
  Expression result = function;
  Builder b(result);
  std::vector<std::size_t> slope;
  for (std::size_t i = 0; i < function.nodes().size(); ++i)
  {
    const auto [operation, value, left, right] = function.nodes()[i];
    switch (operation)
    {
    case Operation::variable:
      slope.push_back(b.number(1.));
      break;
    case Operation::constant:
      slope.push_back(b.number(0.));
      break;
    case Operation::add:
      slope.push_back(b.sum(slope[left], slope[right]));
      break;
    case Operation::subtract:
      slope.push_back(b.difference(slope[left], slope[right]));
      break;
    case Operation::multiply:
      slope.push_back(b.sum(b.product(slope[left], right), b.product(left, slope[right])));
      break;
    case Operation::divide:
      slope.push_back(b.quotient(b.difference(slope[left], b.product(i, slope[right])), right));
      break;
    case Operation::power:
      slope.push_back(b.product(b.product(b.number(value), b.power(left, value - 1.)), slope[left]));
      break;
    case Operation::square_root:
      slope.push_back(b.quotient(slope[left], b.product(b.number(2.), i)));
      break;
    case Operation::exponential:
      slope.push_back(b.product(i, slope[left]));
      break;
    case Operation::logarithm:
      slope.push_back(b.quotient(slope[left], left));
      break;
    }
  }
  result.result = slope[function.result];
  return result;
}

template <std::size_t n, class Function>
void for_each(const double *left, const double *right, double *to, const Function &function)
{
  for (std::size_t i = 0; i < n; ++i)
    to[i] = function(left[i], right[i]);
}

} // namespace

ExpressionLaw::Program::Program(const Expression &function)
{
  const std::vector<Expression::Node> &nodes = function.nodes();
  std::vector<bool> needed(nodes.size(), false);
  needed[function.result] = true;
  std::size_t n_constants = 0;
  for (std::size_t i = nodes.size(); i-- > 0;)
    if (needed[i])
    {
      needed[nodes[i].left] = needed[nodes[i].right] = true;
      n_constants += nodes[i].operation == Operation::constant ? 1 : 0;
    }
  std::vector<std::size_t> place(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const auto &[operation, value, left, right] = nodes[i];
    if (!needed[i])
      continue;
    if (operation == Operation::constant)
    {
      place[i] = constants_.size() / most_stretches;
      constants_.insert(constants_.end(), most_stretches, value);
      continue;
    }
    place[i] = n_constants + steps_.size();
    steps_.push_back({operation, value, place[left], place[right]});
  }
  result_ = place[function.result];
}

template <std::size_t n>
void ExpressionLaw::Program::run(const double *stretches, double *values) const
{
  alignas(64) double of_steps[Expression::max_nodes * n];
  const std::size_t n_constants = constants_.size() / most_stretches;
  const auto at = [&](std::size_t place) -> const double *
  { return place < n_constants ? &constants_[place * most_stretches] : of_steps + (place - n_constants) * n; };
  double *to = of_steps;
  for (const Step &step : steps_)
  {
    const double *const left = at(step.left), *const right = at(step.right);
    switch (step.operation)
    {
    case Operation::variable:
      for_each<n>(stretches, stretches, to, [](double a, double) { return a; });
      break;
    case Operation::add:
      for_each<n>(left, right, to, [](double a, double b) { return a + b; });
      break;
    case Operation::subtract:
      for_each<n>(left, right, to, [](double a, double b) { return a - b; });
      break;
    case Operation::multiply:
      for_each<n>(left, right, to, [](double a, double b) { return a * b; });
      break;
    case Operation::divide:
      for_each<n>(left, right, to, [](double a, double b) { return a / b; });
      break;
    case Operation::square_root:
      for_each<n>(left, right, to, [](double a, double) { return std::sqrt(a); });
      break;
    default:
      for_each<n>(left, right, to,
                  [&step](double a, double) { return support::evaluate(step.operation, step.value, a, 0.); });
    }
    to += n;
  }
  const double *const result = at(result_);
  for (std::size_t i = 0; i < n; ++i)
    values[i] = result[i];
}

ExpressionLaw::ExpressionLaw(Expression psi, double longest) : psi_(std::move(psi))
{
  const Expression force = derivative(psi_);
  energy_ = Program(lowered(psi_));
  force_ = Program(lowered(force));
  stiffness_ = Program(lowered(derivative(force)));
  energy_.run<1>(std::array{1.}.data(), &at_rest_);
  check_law({[this](double l) { return energy(l); }, [this](double l) { return ExpressionLaw::force(l); },
             [this](double l) { return stiffness(l); }},
            smallest_checked_stretch, longest);
  bound_ = std::make_unique<StiffnessBound>(*this, longest);
}

double ExpressionLaw::energy(double stretch) const noexcept
{
  double value;
  energy_.run<1>(&stretch, &value);
  return value - at_rest_;
}

double ExpressionLaw::force(double stretch) const noexcept
{
  double value;
  force_.run<1>(&stretch, &value);
  return value;
}

double ExpressionLaw::stiffness(double stretch) const noexcept
{
  double value;
  stiffness_.run<1>(&stretch, &value);
  return value;
}

void ExpressionLaw::forces(std::size_t n, const double *stretches, double *forces) const noexcept
{
  if (n == 8)
    force_.run<8>(stretches, forces);
  else if (n == 4)
    force_.run<4>(stretches, forces);
  else if (n == 2)
    force_.run<2>(stretches, forces);
  else
    CustomBondLaw::forces(n, stretches, forces);
}

double ExpressionLaw::largest_stiffness(double smallest_stretch) const noexcept
{
  return bound_->from(*this, smallest_stretch);
}

} // namespace latcon::lattice
