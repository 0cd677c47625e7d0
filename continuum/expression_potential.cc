#include "continuum/expression_potential.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace latcon::continuum
{
namespace
{
// Coefficients of l - l0, ..., (l - l0)^4. Rules: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., ch. 13.
constexpr std::size_t n_terms = 5;
using Series = std::array<double, n_terms>;

Series product(const Series &a, const Series &b)
{
  Series c{};
  for (std::size_t k = 0; k < n_terms; ++k)
    for (std::size_t j = 0; j <= k; ++j)
      c[k] += a[j] * b[k - j];
  return c;
}

Series quotient(const Series &a, const Series &b)
{
  Series c{};
  for (std::size_t k = 0; k < n_terms; ++k)
  {
    c[k] = a[k];
    for (std::size_t j = 0; j < k; ++j)
      c[k] -= c[j] * b[k - j];
    c[k] /= b[0];
  }
  return c;
}

// a^p from a y' = p a' y.
Series real_power(const Series &a, const double p)
{
  Series y{std::pow(a[0], p)};
  for (std::size_t k = 1; k < n_terms; ++k)
  {
    for (std::size_t j = 1; j <= k; ++j)
      y[k] += (p * static_cast<double>(j) - static_cast<double>(k - j)) * a[j] * y[k - j];
    y[k] /= static_cast<double>(k) * a[0];
  }
  return y;
}

// Whole powers exist also where a = 0.
Series power(const Series &a, const double p)
{
  constexpr double largest_product = 64.;
  if (p != std::floor(p) || std::abs(p) > largest_product)
    return real_power(a, p);
  Series y{1.};
  for (double done = 0.; done < std::abs(p); done += 1.)
    y = product(y, a);
  return p < 0. ? quotient({1.}, y) : y;
}

Series exponential(const Series &a)
{
  Series y{std::exp(a[0])};
  for (std::size_t k = 1; k < n_terms; ++k)
  {
    for (std::size_t j = 1; j <= k; ++j)
      y[k] += static_cast<double>(j) * a[j] * y[k - j];
    y[k] /= static_cast<double>(k);
  }
  return y;
}

Series logarithm(const Series &a)
{
  Series y{std::log(a[0])};
  for (std::size_t k = 1; k < n_terms; ++k)
  {
    y[k] = static_cast<double>(k) * a[k];
    for (std::size_t j = 1; j < k; ++j)
      y[k] -= static_cast<double>(j) * y[j] * a[k - j];
    y[k] /= static_cast<double>(k) * a[0];
  }
  return y;
}

Series sum(const Series &a, const double factor, const Series &b)
{
  Series c = a;
  for (std::size_t k = 0; k < n_terms; ++k)
    c[k] += factor * b[k];
  return c;
}

Series series(const support::Expression &expression, const double l)
{
  using Operation = support::Expression::Operation;
  std::vector<Series> all;
  all.reserve(expression.nodes().size());
  for (const auto &[operation, value, left, right] : expression.nodes())
    switch (operation)
    {
    case Operation::variable:
      all.push_back({l, 1.});
      break;
    case Operation::constant:
      all.push_back({value});
      break;
    case Operation::add:
      all.push_back(sum(all[left], 1., all[right]));
      break;
    case Operation::subtract:
      all.push_back(sum(all[left], -1., all[right]));
      break;
    case Operation::multiply:
      all.push_back(product(all[left], all[right]));
      break;
    case Operation::divide:
      all.push_back(quotient(all[left], all[right]));
      break;
    case Operation::power:
      all.push_back(power(all[left], value));
      break;
    case Operation::square_root:
      all.push_back(real_power(all[left], 0.5));
      break;
    case Operation::exponential:
      all.push_back(exponential(all[left]));
      break;
    case Operation::logarithm:
      all.push_back(logarithm(all[left]));
      break;
    }
  return all[expression.result];
}
} // namespace

ExpressionPotential::ExpressionPotential(support::Expression psi) : psi_(std::move(psi)), at_rest_(series(psi_, 1.)[0])
{
}

PotentialDerivatives ExpressionPotential::derivatives(const double l) const
{
  const Series psi = series(psi_, l);
  return {psi[0] - at_rest_, psi[1], 2. * psi[2], 6. * psi[3], 24. * psi[4]};
}
} // namespace latcon::continuum
