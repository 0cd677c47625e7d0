/// Small numerical searches and fits.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace latcon::support
{

/// Returns the minimiser of a function with one minimum between a and b, to within `tolerance`; NaN if the function is
/// NaN at a point that is compared. It may be infinite beside the minimum.
template <typename Function>
double golden_section(const Function &function, double a, double b, double tolerance)
{
  const double ratio = 0.5 * (std::sqrt(5.) - 1.);
  double x[] = {b - ratio * (b - a), a + ratio * (b - a)}, f[] = {function(x[0]), function(x[1])};
  while (b - a > tolerance)
  {
    if (std::isnan(f[0]) || std::isnan(f[1]))
      return std::nan("");
    const std::size_t low = f[0] < f[1] ? 0 : 1, other = 1 - low;
    (low == 0 ? b : a) = x[other];
    x[other] = x[low];
    f[other] = f[low];
    x[low] = low == 0 ? b - ratio * (b - a) : a + ratio * (b - a);
    f[low] = function(x[low]);
  }
  return 0.5 * (a + b);
}

/// Returns the slope of the least-squares line through points, two with different x at least.
inline double slope(const std::vector<double> &x, const std::vector<double> &y)
{
  const double n = static_cast<double>(x.size());
  double mean_x = 0., mean_y = 0., xx = 0., xy = 0.;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / xx;
}

} // namespace latcon::support
