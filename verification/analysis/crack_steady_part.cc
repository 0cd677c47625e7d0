#include "verification/analysis/crack_measurement.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "support/dense.h"

namespace latcon::analysis
{
namespace
{

/// Width of the columns over which a path is averaged, in d: a quarter of the shortest wavelength of the search, with
/// enough entries (two to four) to average hops of the tip between neighbouring sites.
constexpr double column_width = 2.;

/// Advance of the tip in a time span over which its position is averaged, in d: large compared with its steps (d / 2, a
/// few d if it hops).
constexpr double span_advance = 6.;

ColumnMeans column_means(const std::vector<TipRecord> &tip, double spacing)
{
  std::vector<double> X, Y;
  for (const TipRecord &entry : tip)
  {
    X.push_back(entry.X);
    Y.push_back(entry.Y);
  }
  return {std::move(X), std::move(Y), column_width * spacing};
}

/// Wavelengths that remain in the window: two, plus a margin for the change of the wavelength when the window moves.
constexpr double kept_periods = 2.2;

/// Returns the amplitude over the wavelength that begins at X_begin, of the path minus the offset and drift of the
/// whole window; none if the wavelength contains fewer than four columns.
std::optional<double> local_amplitude(const ColumnMeans &path, const Sinusoid &curve, double X_begin)
{
  const double q = 2. * std::acos(-1.) / curve.wavelength;
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < path.size(); ++i)
    if (path.X()(i) >= X_begin && path.X()(i) <= X_begin + curve.wavelength)
      inside.push_back(i);
  if (inside.size() < 4)
    return std::nullopt;
  const auto n = static_cast<Eigen::Index>(inside.size());
  Eigen::MatrixXd columns(n, 3);
  Eigen::VectorXd Y(n);
  for (Eigen::Index row = 0; row < n; ++row)
  {
    const double s = path.X()(inside[static_cast<std::size_t>(row)]) - curve.origin;
    columns.row(row) << 1., std::sin(q * s), std::cos(q * s);
    Y(row) = path.Y()(inside[static_cast<std::size_t>(row)]) - curve.slope * s;
  }
  const Eigen::Vector3d coefficients = support::least_squares(columns, Y);
  return std::hypot(coefficients(1), coefficients(2));
}

/// Returns X from which on the oscillation is steady: after the leading wavelengths whose amplitude is below the later
/// one by more than its uncertainty.
double steady_from(const ColumnMeans &path, const SinusoidFit &fit, double X_begin, double X_end, double fraction)
{
  const double wavelength = fit.curve.wavelength;
  std::vector<double> starts, amplitudes;
  for (double X = X_begin; X + wavelength <= X_end; X += wavelength / 8.)
    if (const std::optional<double> amplitude = local_amplitude(path, fit.curve, X))
    {
      starts.push_back(X);
      amplitudes.push_back(*amplitude);
    }
  if (amplitudes.empty())
    return X_begin;
  std::vector<double> later(amplitudes.begin() + static_cast<std::ptrdiff_t>(amplitudes.size() / 2), amplitudes.end());
  std::nth_element(later.begin(), later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2), later.end());
  const double reference = later[later.size() / 2];
  // The uncertainty of an amplitude is inversely proportional to the square root of the measured length.
  const double uncertainty = fit.amplitude.uncertainty * std::sqrt((X_end - X_begin) / wavelength);

  std::size_t first = 0;
  while (first < amplitudes.size() && amplitudes[first] < fraction * reference &&
         amplitudes[first] < reference - 2. * uncertainty)
    ++first;
  if (first == 0)
    return X_begin;
  // Over the wavelength that contains the onset of a steady oscillation, the amplitude is proportional to the part
  // after the onset.
  const double onset = (first < starts.size() ? starts[first] : starts.back()) + (1. - fraction) * wavelength;
  return std::max(X_begin, std::min(onset, X_end - kept_periods * wavelength));
}

} // namespace

std::vector<TipRecord> part_between(const std::vector<TipRecord> &tip, double X_begin, double X_end)
{
  std::vector<TipRecord> part;
  std::copy_if(tip.begin(), tip.end(), std::back_inserter(part),
               [&](const TipRecord &entry) { return entry.X >= X_begin && entry.X <= X_end; });
  return part;
}

SteadyPart find_steady_part(const std::vector<TipRecord> &tip, double X_begin, double X_end,
                            const CrackMeasurementOptions &rule)
{
  SteadyPart result;
  result.X_begin = X_begin;
  constexpr unsigned int max_moves = 5;
  for (unsigned int move = 0;; ++move)
  {
    const ColumnMeans path = column_means(part_between(tip, result.X_begin, X_end), rule.lattice_spacing);
    result.is_long_enough = path.size() >= min_columns_of_sinusoid;
    result.sinusoid = fit_sinusoid(path, rule.min_wavelength * rule.lattice_spacing, 1e-3 * rule.lattice_spacing);
    if (!result.sinusoid || move == max_moves)
      return result;
    const SinusoidFit &fit = *result.sinusoid;
    const bool is_clear = fit.amplitude.value > 3. * fit.amplitude.uncertainty;
    if (!is_clear || X_end - result.X_begin < kept_periods * fit.curve.wavelength)
      return result;
    const double steady_begin = steady_from(path, fit, result.X_begin, X_end, rule.steady_amplitude);
    if (steady_begin - result.X_begin < 0.05 * fit.curve.wavelength)
      return result;
    result.X_begin = steady_begin;
  }
}

std::optional<Measured> crest_amplitude(const std::vector<TipRecord> &tip, double spacing, const Sinusoid &curve)
{
  if (tip.empty())
    return std::nullopt;
  const ColumnMeans path = column_means(tip, spacing);
  const auto n_waves = static_cast<Eigen::Index>((tip.back().X - tip.front().X) / curve.wavelength);
  Eigen::ArrayXd highest = Eigen::ArrayXd::Constant(n_waves, -std::numeric_limits<double>::infinity());
  Eigen::ArrayXd lowest = -highest;
  for (Eigen::Index i = 0; i < path.size(); ++i)
  {
    const double X = path.X()(i);
    const auto wave = static_cast<Eigen::Index>((X - tip.front().X) / curve.wavelength);
    if (wave >= n_waves)
      break;
    const double Y = path.Y()(i) - curve.slope * (X - curve.origin);
    highest(wave) = std::max(highest(wave), Y);
    lowest(wave) = std::min(lowest(wave), Y);
  }
  const Eigen::ArrayXd half_heights = 0.5 * (highest - lowest);
  if (n_waves < 2 || !half_heights.isFinite().all())
    return std::nullopt;
  const double mean = half_heights.mean();
  const double variance = (half_heights - mean).square().sum() / static_cast<double>(n_waves - 1);
  return Measured{mean, std::sqrt(variance / static_cast<double>(n_waves))};
}

std::optional<Measured> steady_speed(const std::vector<TipRecord> &tip, double spacing, double TipRecord::*coordinate)
{
  constexpr std::size_t min_entries = 10;
  if (tip.size() < min_entries || !(tip.back().t > tip.front().t) || !(tip.back().X > tip.front().X))
    return std::nullopt;
  const double advance = tip.back().X - tip.front().X;
  const auto n_spans = static_cast<Eigen::Index>(std::max(8., std::ceil(advance / (span_advance * spacing))));
  const double span = (tip.back().t - tip.front().t) / static_cast<double>(n_spans);
  Eigen::VectorXd time(n_spans), position(n_spans);
  std::size_t entry = 0;
  for (Eigen::Index i = 0; i < n_spans; ++i)
  {
    const double begin = tip.front().t + static_cast<double>(i) * span;
    const double end = begin + span;
    double integral = 0.;
    double now = begin;
    while (true)
    {
      const bool moves_on = entry + 1 < tip.size() && tip[entry + 1].t < end;
      const double until = moves_on ? std::max(now, tip[entry + 1].t) : end;
      integral += tip[entry].*coordinate * (until - now);
      now = until;
      if (!moves_on)
        break;
      ++entry;
    }
    time(i) = begin + 0.5 * span;
    position(i) = integral / span;
  }
  return fit_slope(time, position, 1e-3 * spacing);
}

} // namespace latcon::analysis
