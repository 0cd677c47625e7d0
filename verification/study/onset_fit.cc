#include "verification/study/onset_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace latcon::study
{
namespace
{

constexpr std::size_t min_points = 5;
constexpr double n_parameters = 3.;
// Largest distance of p_c below the smallest parameter, over the range of the parameters. Beyond it the curve is an
// exponential to within the scatter of any data, and no onset.
constexpr double max_distance = 10.;
// Smallest such distance: at p_c = p the curve is 0 there, whatever the exponent.
constexpr double min_distance = 1e-9;

// Minimum of a function between two numbers, by a scan and Brent's method about its smallest value.
struct Minimum
{
  double at, value;
};

Minimum minimise(const std::function<double(double)> &function, double low, double high, int n_steps)
{
  const double step = (high - low) / n_steps;
  Minimum best{low, function(low)};
  for (int i = 1; i <= n_steps; ++i)
    if (const double value = function(low + i * step); value < best.value)
      best = {low + i * step, value};
  constexpr int half_of_the_digits = std::numeric_limits<double>::digits / 2;
  const auto [at, value] = boost::math::tools::brent_find_minima(function, std::max(low, best.at - step),
                                                                 std::min(high, best.at + step), half_of_the_digits);
  return value < best.value ? Minimum{at, value} : best;
}

// Sums of squares of the curve, in parameters scaled to [0, 1].
class Squares
{
public:
  explicit Squares(const std::vector<OnsetPoint> &points) : start_(points.front().parameter)
  {
    range_ = points.back().parameter - start_;
    for (const OnsetPoint &point : points)
    {
      x_.push_back((point.parameter - start_) / range_);
      y_.push_back(point.mean.mean);
      weight_.push_back(static_cast<double>(point.mean.n));
    }
  }

  // Prefactor of least squares, over the unit of the scaled parameters. @param u logarithm of the distance of p_c
  double prefactor(double exponent, double u) const
  {
    double product = 0., square = 0.;
    for (std::size_t i = 0; i < x_.size(); ++i)
    {
      const double power = std::pow(x_[i] + std::exp(u), exponent);
      product += weight_[i] * power * y_[i];
      square += weight_[i] * power * power;
    }
    return product / square;
  }

  double operator()(double exponent, double u) const
  {
    const double factor = prefactor(exponent, u);
    double sum = 0.;
    for (std::size_t i = 0; i < x_.size(); ++i)
      sum += weight_[i] * std::pow(y_[i] - factor * std::pow(x_[i] + std::exp(u), exponent), 2);
    return sum;
  }

  Minimum over_onset(double exponent) const
  {
    return minimise([&](double u) { return (*this)(exponent, u); }, least_u, most_u, 120);
  }

  Minimum over_exponent(double u) const
  {
    return minimise([&](double exponent) { return (*this)(exponent, u); }, min_onset_exponent, max_onset_exponent, 60);
  }

  double onset(double u) const { return start_ - range_ * std::exp(u); }
  double range() const { return range_; }

  const double least_u = std::log(min_distance), most_u = std::log(max_distance);

private:
  double start_, range_;
  std::vector<double> x_, y_, weight_;
};

// First value from `from` towards `end` at which a function that is below a level at `from` reaches it; `end` if it
// does not.
double crossing(const std::function<double(double)> &function, double level, double from, double end)
{
  constexpr int n_steps = 60;
  const double step = (end - from) / n_steps;
  if (step == 0.)
    return end;
  const auto excess = [&](double x) { return function(x) - level; };
  for (int i = 1; i <= n_steps; ++i)
  {
    const double a = from + (i - 1) * step, b = from + i * step;
    if (!(excess(b) > 0.))
      continue;
    if (!(excess(a) < 0.))
      return a;
    std::uintmax_t n_iterations = 100;
    const auto [low, high] = boost::math::tools::toms748_solve(
      excess, std::min(a, b), std::max(a, b), boost::math::tools::eps_tolerance<double>(30), n_iterations);
    return 0.5 * (low + high);
  }
  return end;
}

// Pooled variance of one measurement, and its degrees of freedom.
struct Scatter
{
  double variance, freedom;
};

Scatter pooled(const std::vector<OnsetPoint> &points)
{
  double squares = 0., freedom = 0., least = 0., total = 0.;
  for (const OnsetPoint &point : points)
  {
    const auto n = static_cast<double>(point.mean.n);
    total += n;
    least += n * point.mean.min_variance;
    if (point.mean.n < 2)
      continue;
    freedom += n - 1.;
    squares += (n - 1.) * point.mean.variance;
  }
  if (!(squares > 0.))
    return {std::numeric_limits<double>::quiet_NaN(), 0.};
  return {SampleMean{0., 1, squares / freedom, least / total}.floored_variance(), freedom};
}

bool is_usable(const std::vector<OnsetPoint> &points)
{
  if (points.size() < min_points)
    return false;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points[i].parameter) || !(points[i].mean.mean > 0.) || !std::isfinite(points[i].mean.mean) ||
        points[i].mean.n < 1 || (i > 0 && !(points[i].parameter > points[i - 1].parameter)))
      return false;
  return true;
}

} // namespace

std::optional<OnsetFit> fit_onset(std::vector<OnsetPoint> points)
{
  // NaN would make the order undefined.
  if (std::any_of(points.begin(), points.end(), [](const OnsetPoint &point) { return std::isnan(point.parameter); }))
    return {};
  std::sort(points.begin(), points.end(),
            [](const OnsetPoint &a, const OnsetPoint &b) { return a.parameter < b.parameter; });
  if (!is_usable(points))
    return {};
  const Scatter scatter = pooled(points);
  if (!std::isfinite(scatter.variance))
    return {};

  const Squares squares(points);
  const auto of_exponent = [&](double exponent) { return squares.over_onset(exponent).value; };
  const auto of_onset = [&](double u) { return squares.over_exponent(u).value; };
  const Minimum best = minimise(of_exponent, min_onset_exponent, max_onset_exponent, 60);
  const double u = squares.over_onset(best.at).at;

  OnsetFit fit{};
  const double freedom_of_fit = static_cast<double>(points.size()) - n_parameters;
  const double mean_square = best.value / freedom_of_fit;
  fit.p_fit = boost::math::cdf(
    boost::math::complement(boost::math::fisher_f(freedom_of_fit, scatter.freedom), mean_square / scatter.variance));
  // A variance has the degrees of freedom of the data that it is estimated from.
  const Scatter of_interval = mean_square > scatter.variance ? Scatter{mean_square, freedom_of_fit} : scatter;
  const double allowed = boost::math::quantile(boost::math::fisher_f(1., of_interval.freedom), 1. - significance);
  const double level = best.value + allowed * of_interval.variance;
  fit.exponent = {best.at, crossing(of_exponent, level, best.at, min_onset_exponent),
                  crossing(of_exponent, level, best.at, max_onset_exponent)};
  fit.onset = {squares.onset(u), squares.onset(crossing(of_onset, level, u, squares.most_u)),
               squares.onset(crossing(of_onset, level, u, squares.least_u))};
  fit.prefactor = squares.prefactor(best.at, u) / std::pow(squares.range(), best.at);
  return fit;
}

} // namespace latcon::study
