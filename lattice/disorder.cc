#include "lattice/disorder.h"

#include <cmath>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

const double sqrt3 = std::sqrt(3.);

// Uniform in (0, 1), symmetric about 1/2 and never an end: from the upper 53 bits.
double uniform(std::uint64_t bits)
{
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}
constexpr double smallest_uniform = 0x1p-54;

// Standard deviation that a normal distribution keeps when it is cut off at c on either side, over that before.
double kept_width(double c)
{
  const double density = std::exp(-0.5 * c * c) / std::sqrt(2. * M_PI);
  return std::sqrt(1. - 2. * c * density / std::erf(c / std::sqrt(2.)));
}

// The shape of a Weibull distribution from its coefficient of variation, which decreases with it.
double weibull_shape(double width)
{
  double low = 1., high = 2. / width; // the width is at least 1 / shape for shapes from 1 on, and less than 1.3 / shape
  while (high - low > 1e-15 * high)
  {
    const double middle = 0.5 * (low + high);
    const double variance = std::expm1(std::lgamma(1. + 2. / middle) - 2. * std::lgamma(1. + 1. / middle));
    (std::sqrt(variance) > width ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace

double Distribution::widest(Kind kind)
{
  return kind == Kind::uniform ? 1. / sqrt3 : kind == Kind::normal ? kept_width(cut_off) / cut_off : 1.;
}

Distribution::Distribution(Kind kind, double width) : kind_(kind), width_(kind == Kind::none ? 0. : width)
{
  if (kind == Kind::none)
    return;
  const bool is_allowed = kind == Kind::weibull ? width <= widest(kind) : width < widest(kind);
  support::require(width > 0. && is_allowed, "the width of a distribution of bonds is out of its range");
  if (kind == Kind::weibull)
  {
    exponent_ = 1. / weibull_shape(width);
    scale_ = 1. / std::tgamma(1. + exponent_);
    smallest_ = 0.;
    largest_ = scale_ * std::pow(-std::log(smallest_uniform), exponent_);
    return;
  }
  scale_ = kind == Kind::uniform ? sqrt3 * width : width / kept_width(cut_off);
  const double range = kind == Kind::uniform ? scale_ : cut_off * scale_;
  smallest_ = 1. - range;
  largest_ = 1. + range;
}

double Distribution::factor(std::uint64_t key) const
{
  if (kind_ == Kind::none)
    return 1.;
  if (kind_ == Kind::uniform)
    return 1. + scale_ * (2. * uniform(splitmix64(key)) - 1.);
  if (kind_ == Kind::weibull)
    return scale_ * std::pow(-std::log(uniform(splitmix64(key))), exponent_);
  // Box and Muller (1958); pairs beyond the cut are drawn again.
  for (std::uint64_t stream = splitmix64(key);; stream = splitmix64(stream))
  {
    const double radius = std::sqrt(-2. * std::log(uniform(splitmix64(stream + 1))));
    const double normal = radius * std::cos(2. * M_PI * uniform(splitmix64(stream + 2)));
    if (std::abs(normal) <= cut_off)
      return 1. + scale_ * normal;
  }
}

} // namespace latcon::lattice
