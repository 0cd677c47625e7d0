#include "continuum/damage/viscous_stages.h"

#include "continuum/errors.h"

#include <array>
#include <cmath>
#include <complex>
#include <string>

namespace latcon::continuum
{
namespace
{
// Chebyshev polynomial T_n(w) and its first two derivatives, w > 1, from T_n(cosh z) = cosh n z.
std::array<double, 3> chebyshev(const unsigned int n, const double w)
{
  const double z = std::acosh(w);
  const double value = std::cosh(n * z);
  const double first = n * std::sinh(n * z) / std::sinh(z);
  // From the differential equation (1 - w^2) T'' - w T' + n^2 T = 0.
  return {value, first, (w * first - static_cast<double>(n) * n * value) / (1. - w * w)};
}

// Argument w_0 > 1 at which the polynomials are taken, eq. (C.73): the damping that waves in a viscous material need.
double argument(const unsigned int n)
{
  return 1. + 2. / (static_cast<double>(n) * n);
}
} // namespace

ViscousStages::ViscousStages(const unsigned int n)
{
  if (n < 2)
    throw InvalidInput("a Runge-Kutta-Chebyshev method of second order has two stages or more");
  const double w0 = argument(n);
  const auto last = chebyshev(n, w0);
  const double w1 = last[1] / last[2];
  const auto weight = [w0](const unsigned int j)
  {
    const auto T = chebyshev(j < 2 ? 2 : j, w0);
    return T[2] / (T[1] * T[1]);
  };
  first_ = weight(1) * w1;
  for (unsigned int j = 2; j <= n; ++j)
  {
    const double ratio = weight(j) / weight(j - 1);
    const double now = 2. * ratio * w1;
    stages_.push_back(
      {2. * ratio * w0, -weight(j) / weight(j - 2), now, -(1. - weight(j - 1) * chebyshev(j - 1, w0)[0]) * now});
  }
}

double ViscousStages::real_limit(const unsigned int n)
{
  const double w0 = argument(n);
  const auto T = chebyshev(n, w0);
  return (1. + w0) * T[2] / T[1];
}

unsigned int ViscousStages::required(const double limit)
{
  if (!(limit >= 0. && std::isfinite(limit)))
    throw InvalidInput("the stiffness of a step must be finite and not negative");
  unsigned int n = 2;
  while (n <= max_stages && real_limit(n) < limit)
    ++n;
  if (n > max_stages)
    throw InvalidInput("the time step is too long for the viscosity: a step would have more than " +
                       std::to_string(max_stages) + " stages");
  return n;
}

// Waves with damping proportional to stiffness, from long to short ones.
bool ViscousStages::damps(const double rate, const double wave) const
{
  constexpr unsigned int n_waves = 60;
  for (unsigned int k = 0; k < n_waves; ++k)
  {
    const double q = std::pow(10., -4. * k / (n_waves - 1.));
    const std::complex<double> half = -0.5 * rate * q, root = std::sqrt(half * half - wave * wave * q);
    for (const std::complex<double> z : {half + root, half - root})
    {
      std::complex<double> before = 1., last = 1. + first_ * z;
      for (const Stage &c : stages_)
      {
        const std::complex<double> next = 1. - c.mu - c.nu + c.mu * last + c.nu * before + z * (c.now * last + c.start);
        before = last;
        last = next;
      }
      if (!(std::abs(last) <= 1. + 1e-9))
        return false;
    }
  }
  return true;
}

unsigned int ViscousStages::required(const double limit, const double wave)
{
  const unsigned int fewest = required(limit);
  for (unsigned int n = fewest; n < fewest + 10; ++n)
    if (const ViscousStages method(n); method.damps(limit, wave) && method.damps(0.25 * limit, wave))
      return n;
  throw InvalidInput("the time step is too long: waves that the viscosity hardly damps would grow");
}
} // namespace latcon::continuum
