#include "verification/claims/steady_crack/steady_crack.h"

#include <cmath>
#include <stdexcept>

namespace latcon::claims
{
namespace
{

const double pi = std::acos(-1.);

// The integral of (S.8) by the midpoint rule in x, omega = scale sinh x: even steps over the slow waves of the strip,
// ever longer ones towards the fast decay at high frequencies. The integrand is even in x and analytic, so that the
// rule converges faster than any power of the step.
double logarithm_of_driving(const HalfStrip &half, std::size_t points)
{
  const CrackStrip &strip = half.strip();
  const double gamma = 1. / strip.viscosity;
  const double scale = half.speed() / static_cast<double>(strip.layers());
  const double highest = 1e4 * (1. + gamma);
  const double dx = std::asinh(highest / scale) / static_cast<double>(points);
  double sum = 0., argument = 0.;
  for (std::size_t i = 0; i < points; ++i)
  {
    const double x = (static_cast<double>(i) + 0.5) * dx;
    const double omega = scale * std::sinh(x);
    // (S.5)
    const HalfStrip::Complex phi = 1. + half.stiffness(omega) * half.compliance(omega);
    // The argument is followed from 0 at omega = 0.
    argument += std::remainder(std::arg(phi) - argument, 2. * pi);
    sum += scale * std::cosh(x) * gamma / (omega * omega + gamma * gamma) *
           (std::log(std::abs(phi)) - gamma * argument / omega);
  }
  // It must come back to 0: else Phi has no factors of the kind that (S.6) needs.
  if (std::abs(argument) > 1.)
    throw std::runtime_error("the response of the strip turns around the origin: there is no steady crack");
  return sum * dx / pi;
}

} // namespace

double steady_driving(const CrackStrip &strip, double speed)
{
  const HalfStrip half(strip, speed);
  constexpr double tolerance = 1e-9;
  constexpr std::size_t most = std::size_t(1) << 20;
  double coarse = logarithm_of_driving(half, std::size_t(1) << 10);
  for (std::size_t points = std::size_t(1) << 11; points <= most; points *= 2)
  {
    const double fine = logarithm_of_driving(half, points);
    if (std::abs(fine - coarse) < tolerance)
      return std::exp(fine);
    coarse = fine;
  }
  throw std::runtime_error("the integral for the driving of a steady crack does not converge");
}

double steady_speed(const CrackStrip &strip, double driving, double fastest)
{
  const auto excess = [&](double speed) { return steady_driving(strip, speed) - driving; };
  double high = fastest;
  if (!(excess(high) > 0.))
    throw std::runtime_error("a steady crack under this driving is faster than the fastest that is looked for");
  // Down from the fast end to the first speed whose driving is less.
  const double step = fastest / 64.;
  double low = high - step;
  while (low > 0.5 * step && excess(low) > 0.)
  {
    high = low;
    low -= step;
  }
  if (low <= 0.5 * step)
    throw std::runtime_error("no steady crack runs under so weak a driving");
  for (int i = 0; i < 50 && high - low > 1e-10; ++i)
  {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0. ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace latcon::claims
