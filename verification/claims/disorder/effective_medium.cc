#include "verification/claims/disorder/effective_medium.h"

#include <cmath>

#include <Eigen/LU>
#include <boost/math/quadrature/tanh_sinh.hpp>

namespace latcon::claims
{
namespace
{

using Kind = lattice::Distribution::Kind;

// Also of functions whose derivatives are singular at an end, as those of the density of a Weibull distribution.
double integral(double from, double to, const std::function<double(double)> &f)
{
  static thread_local boost::math::quadrature::tanh_sinh<double> rule; // integrate() is not const
  return rule.integrate(f, from, to, 1e-12);
}

double weibull_mean(double shape, double scale, const std::function<double(double)> &f)
{
  const double end = std::pow(40., 1. / shape); // beyond which e^-40 is left
  const auto density = [&](double s) { return shape * std::pow(s, shape - 1.) * std::exp(-std::pow(s, shape)); };
  return integral(0., end, [&](double s) { return density(s) * f(scale * s); });
}

// Stiffness A0 psi'' / l of an undeformed bond per sheet thickness [N/m^2].
double bond_stiffness(const lattice::TriangularLattice &sheet, const lattice::Shell &shell, std::size_t kind)
{
  return lattice::cross_section(shell, sheet) * lattice::stiffness(shell.law, 1.) / sheet.rest_length(kind);
}

} // namespace

double mean_over(const lattice::Distribution &distribution, const std::function<double(double)> &function)
{
  const double width = distribution.width();
  if (distribution.kind() == Kind::uniform)
  {
    const double half = std::sqrt(3.) * width;
    return integral(1. - half, 1. + half, function) / (2. * half);
  }
  if (distribution.kind() == Kind::normal)
  {
    constexpr double c = lattice::Distribution::cut_off;
    const auto weight = [](double z) { return std::exp(-0.5 * z * z); };
    const double norm = integral(-c, c, weight);
    const double variance = integral(-c, c, [&](double z) { return weight(z) * z * z; }) / norm;
    const double scale = width / std::sqrt(variance);
    return integral(-c, c, [&](double z) { return weight(z) * function(1. + scale * z); }) / norm;
  }
  // The shape by bisection, from moments.
  double low = 1., high = 2. / width;
  for (int i = 0; i < 100; ++i)
  {
    const double shape = 0.5 * (low + high);
    const double ratio = std::tgamma(1. + 2. / shape) / std::pow(std::tgamma(1. + 1. / shape), 2);
    (ratio > 1. + width * width ? low : high) = shape;
  }
  return weibull_mean(low, 1. / std::tgamma(1. + 1. / low), function);
}

EffectiveMedium effective_medium(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                 const lattice::Distribution &distribution)
{
  using lattice::n_bond_kinds;
  EffectiveMedium medium;
  std::array<double, n_bond_kinds> stiffness{};
  std::array<Eigen::Matrix2d, n_bond_kinds> direction;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d n = sheet.bond_vector(kind).normalized();
      direction[kind] = n * n.transpose();
      stiffness[kind] = bond_stiffness(sheet, *shell, kind);
      medium.factor[kind] = 1.;
    }
  const bool along_x = sheet.orientation() == lattice::Orientation::rows_along_crack;
  const std::size_t n_x = along_x ? sheet.columns() : sheet.rows(), n_y = along_x ? sheet.rows() : sheet.columns();
  const auto find_shares = [&]
  {
    medium.share = {};
    for (std::size_t i = 0; i < n_x; ++i)
      for (std::size_t j = 0; j < n_y; ++j)
      {
        if (i + j == 0)
          continue; // a translation
        const Eigen::Vector2d K(2. * M_PI * static_cast<double>(i) / sheet.length(),
                                2. * M_PI * static_cast<double>(j) / sheet.height());
        std::array<Eigen::Matrix2d, n_bond_kinds> of_kind;
        Eigen::Matrix2d dynamical = Eigen::Matrix2d::Zero();
        for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
          if (medium.factor[kind] > 0.)
          {
            of_kind[kind] = medium.factor[kind] * stiffness[kind] * 2. *
                            (1. - std::cos(K.dot(sheet.bond_vector(kind)))) * direction[kind];
            dynamical += of_kind[kind];
          }
        const Eigen::Matrix2d inverse = dynamical.inverse();
        for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
          if (medium.factor[kind] > 0.)
            medium.share[kind] += (of_kind[kind] * inverse).trace() / static_cast<double>(n_x * n_y);
      }
  };
  // The shares depend on ratios of the factors alone, so that few rounds are enough.
  for (int round = 0; round < 8; ++round)
  {
    find_shares();
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      for (int i = 0; medium.factor[kind] > 0. && i < 20; ++i)
      {
        const double a = medium.share[kind], g = medium.factor[kind];
        const auto weight = [a, g](double factor) { return 1. / (1. + a * (factor / g - 1.)); };
        medium.factor[kind] = mean_over(distribution, [&](double factor) { return factor * weight(factor); }) /
                              mean_over(distribution, weight);
      }
  }
  return medium;
}

} // namespace latcon::claims
