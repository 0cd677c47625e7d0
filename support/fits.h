/// Small numerical searches and fits.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace latcon::support
{

/// Returns the minimiser of a function with one minimum between a and b, to within `tolerance`; NaN if the function is
/// not finite at a point that is compared.
template <typename Function>
double golden_section(const Function &function, double a, double b, double tolerance)
{
  const double ratio = 0.5 * (std::sqrt(5.) - 1.);
  double left = b - ratio * (b - a), right = a + ratio * (b - a);
  double at_left = function(left), at_right = function(right);
  while (b - a > tolerance)
  {
    if (!std::isfinite(at_left) || !std::isfinite(at_right))
      return std::nan("");
    if (at_left < at_right)
    {
      b = right;
      right = left;
      at_right = at_left;
      left = b - ratio * (b - a);
      at_left = function(left);
    }
    else
    {
      a = left;
      left = right;
      at_left = at_right;
      right = a + ratio * (b - a);
      at_right = function(right);
    }
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
