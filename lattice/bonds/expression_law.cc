#include "lattice/bonds/expression_law.h"

#include <cmath>
#include <utility>

#include <Eigen/Core>

namespace latcon::lattice
{
namespace
{

using std::exp, std::log, std::pow, std::sqrt;
using support::Expression;

// A number for each of n bonds.
template <int n>
using Block = Eigen::Array<double, n, 1>;

// Bond by bond, as Eigen's functions have other bits for several numbers than for one.
template <int n>
Block<n> exp(const Block<n> &a)
{
  return a.unaryExpr([](double of_bond) { return std::exp(of_bond); });
}
template <int n>
Block<n> log(const Block<n> &a)
{
  return a.unaryExpr([](double of_bond) { return std::log(of_bond); });
}
template <int n>
Block<n> pow(const Block<n> &a, double exponent)
{
  return a.unaryExpr([exponent](double of_bond) { return std::pow(of_bond, exponent); });
}

// A function of the stretch and its derivative, for automatic differentiation. @tparam T double, Block, or Dual for two
// derivatives
template <class T>
struct Dual
{
  // cppcheck-suppress uninitMemberVar ; thousands are assigned before they are read
  Dual() = default;
  Dual(T value_, T slope_) : value(value_), slope(slope_) {}
  // cppcheck-suppress useInitializationList ; a number that makes an array would be its size
  Dual(double constant) { value = constant, slope = 0.; }

  friend Dual operator+(const Dual &a, const Dual &b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual &a, const Dual &b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual &a, const Dual &b)
  {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual &a, const Dual &b)
  {
    const T inverse = 1. / b.value, ratio = a.value * inverse;
    return {ratio, (a.slope - ratio * b.slope) * inverse};
  }
  friend Dual sqrt(const Dual &a)
  {
    const T root = sqrt(a.value);
    return {root, 0.5 * a.slope / root};
  }
  friend Dual exp(const Dual &a)
  {
    const T power = exp(a.value);
    return {power, power * a.slope};
  }
  friend Dual log(const Dual &a) { return {log(a.value), a.slope / a.value}; }
  friend Dual pow(const Dual &a, double exponent)
  {
    constexpr double largest_product = 64.;
    if (exponent != std::round(exponent) || std::abs(exponent) > largest_product)
      return {pow(a.value, exponent), exponent * pow(a.value, exponent - 1.) * a.slope};
    if (exponent == 0.)
      return 1.;
    const Dual factor = exponent < 0. ? 1. / a : a;
    Dual product = factor;
    for (double left = std::abs(exponent); left > 1.; --left)
      product = product * factor;
    return product;
  }

  T value, slope;
};

template <class Number>
Number value_of(const Expression &function, const Number &stretch)
{
  Number values[Expression::max_nodes];
  Number *to = values;
  for (const auto &[operation, value, left, right] : function.nodes())
    *to++ = operation == Expression::Operation::variable
              ? stretch
              : support::evaluate(operation, value, values[left], values[right]);
  return values[function.result];
}

template <int n>
void slopes(const Expression &function, const double *stretches, double *slopes)
{
  const Dual<Block<n>> stretch(Eigen::Map<const Block<n>>(stretches), Block<n>::Ones());
  Eigen::Map<Block<n>>{slopes} = value_of(function, stretch).slope;
}

} // namespace

ExpressionLaw::ExpressionLaw(Expression psi, double longest) : psi_(std::move(psi))
{
  at_rest_ = derivatives(1.)[0];
  check(longest);
}

std::array<double, 3> ExpressionLaw::derivatives(double stretch) const noexcept
{
  const auto psi = value_of<Dual<Dual<double>>>(psi_, {{stretch, 1.}, 1.});
  return {psi.value.value - at_rest_, psi.slope.value, psi.slope.slope};
}

double ExpressionLaw::force(double stretch) const noexcept
{
  double slope = 0.;
  slopes<1>(psi_, &stretch, &slope);
  return slope;
}

void ExpressionLaw::forces(std::size_t n, const double *stretches, double *forces) const noexcept
{
  if (n == 8)
    slopes<8>(psi_, stretches, forces);
  else if (n == 4)
    slopes<4>(psi_, stretches, forces);
  else if (n == 2)
    slopes<2>(psi_, stretches, forces);
  else
    CustomBondLaw::forces(n, stretches, forces);
}

} // namespace latcon::lattice
