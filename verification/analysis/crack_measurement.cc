#include "verification/analysis/crack_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "support/text_wrap.h"

namespace latcon::analysis
{
namespace
{

void check(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks, const CrackMeasurementOptions &o)
{
  bool is_good = o.lattice_spacing > 0. && o.lattice_spacing < o.strip_length && std::isfinite(o.strip_length) &&
                 o.end_time >= 0. && std::isfinite(o.end_time) && o.seed_tip_X >= 0. && o.seed_tip_X < o.strip_length;
  for (std::size_t i = 0; i < tip.size(); ++i)
  {
    const TipRecord &now = tip[i], &before = tip[i > 0 ? i - 1 : 0];
    is_good = is_good && std::isfinite(now.t + now.X + now.Y + now.x + now.y) && now.t <= o.end_time &&
              now.t >= before.t && now.X >= before.X;
  }
  for (const BreakRecord &bond : breaks)
    is_good = is_good && std::isfinite(bond.t + bond.X + bond.Y);
  if (!is_good)
    throw std::invalid_argument("crack measurement: a record is not finite or goes back, or an option is out of range");
}

/// Returns the time at which the tip first reached X; requires tip.back().X >= X.
double time_at(const std::vector<TipRecord> &tip, double X)
{
  return std::find_if(tip.begin(), tip.end(), [&](const TipRecord &entry) { return entry.X >= X; })->t;
}

/// Returns X of the tip at time t.
double X_at(const std::vector<TipRecord> &tip, double t, double seed_tip_X)
{
  double X = seed_tip_X;
  for (const TipRecord &entry : tip)
    if (entry.t <= t)
      X = std::max(X, entry.X);
  return X;
}

/// Returns true if the tip stands still before the clamp zone: in the last period of the run, in which it would have
/// advanced by `arrest_fraction` of the strip at its mean speed, it advanced by less than a tenth of that. The mean
/// speed is measured from 10 % to 90 % of the advance, to exclude a slow start and a slow end.
bool stands_still(const std::vector<TipRecord> &tip, const CrackMeasurementOptions &o)
{
  const double X_last = tip.back().X;
  if (X_last >= (1. - o.clamp_fraction) * o.strip_length)
    return false;
  const double advance = X_last - o.seed_tip_X;
  const double duration = time_at(tip, o.seed_tip_X + 0.9 * advance) - time_at(tip, o.seed_tip_X + 0.1 * advance);
  if (!(duration > 0.))
    return false;
  const double expected = o.arrest_fraction * o.strip_length;
  const double patience = expected * duration / (0.8 * advance);
  return patience <= o.end_time && X_last - X_at(tip, o.end_time - patience, o.seed_tip_X) < 0.1 * expected;
}

/// Sets pattern and reason of a crack that neither branched nor stopped.
void decide_oscillating_or_straight(CrackMeasurement &m, bool is_long_enough, const CrackMeasurementOptions &o)
{
  if (!m.sinusoid)
  {
    if (is_long_enough)
      m.pattern = CrackPattern::straight;
    m.reason = is_long_enough
                 ? "the path has no waviness"
                 : support::formatted("only %.3g mm of path, or too few entries in it: too short to decide",
                                      1e3 * (m.X_end - m.X_begin));
    return;
  }
  const SinusoidFit &fit = *m.sinusoid;
  const double amplitude = fit.amplitude.value / o.lattice_spacing, share = 100. * fit.share_of_path;
  const bool is_high = amplitude >= o.min_amplitude;
  const bool has_periods = m.periods >= o.min_periods;
  const bool is_path = 2. * std::acos(-1.) * fit.curve.amplitude() / fit.curve.wavelength <= o.max_steepness;
  const std::string sinusoid = support::formatted(
    "the best-fitting sinusoid has an amplitude of %.3g d, %s the %.3g d of an oscillation (%.3g mm, wavelength "
    "%.3g mm, %.1f periods)",
    amplitude, is_high ? "at least" : "less than", o.min_amplitude, 1e3 * fit.amplitude.value,
    1e3 * fit.wavelength.value, m.periods);
  if (is_high && is_path && has_periods && fit.share_of_path >= o.min_share && fit.log_evidence >= o.min_log_evidence)
  {
    m.wavelength = fit.wavelength;
    m.amplitude = fit.amplitude;
    if (m.periods < o.clear_periods)
      m.reason = sinusoid + support::formatted(", but fewer than %.3g periods: an oscillation is likely, not certain",
                                               o.clear_periods);
    else if (fit.log_evidence < o.clear_log_evidence)
      m.reason = sinusoid +
                 support::formatted(", but its log evidence %.1f is below %.3g: an oscillation is likely, not certain",
                                    fit.log_evidence, o.clear_log_evidence);
    else
    {
      m.pattern = CrackPattern::oscillating;
      m.reason =
        sinusoid + support::formatted(" and makes up %.0f %% of the path, log evidence %.1f", share, fit.log_evidence);
    }
    return;
  }
  // The distance includes hops: a straight path with hops is straight; a path that follows a sinusoid or strays far is
  // undecided.
  const double strayed_rms = fit.residual_rms / std::sqrt(std::max(1. - fit.R_squared, 1e-12)) / o.lattice_spacing;
  const bool is_wavy = is_high && (fit.R_squared >= o.min_share || strayed_rms > o.max_straight_rms);
  if (!is_wavy)
    m.pattern = CrackPattern::straight;
  if (!is_high)
    m.reason = sinusoid;
  else if (!is_wavy)
    m.reason = sinusoid + support::formatted(
                            ", but explains only %.0f %% of a path that stays within %.2g d (rms) of a straight line",
                            100. * fit.R_squared, strayed_rms);
  else if (!is_path)
    m.reason = sinusoid + ", but is too steep: the tip jumps between strands";
  else if (!has_periods)
    m.reason = sinusoid + support::formatted(", but fewer than %.3g periods: it may be a bend", o.min_periods);
  else
    m.reason = sinusoid +
               support::formatted(", but makes up %.0f %% of the path with log evidence %.1f; an oscillation needs at "
                                  "least %.0f %% and %.3g: the path is short or irregular",
                                  share, fit.log_evidence, 100. * o.min_share, o.min_log_evidence);
}

} // namespace

const char *to_string(CrackPattern pattern)
{
  constexpr std::array names{"straight", "oscillating", "branching", "arrested", "undecided"};
  return names.at(static_cast<std::size_t>(pattern));
}

CrackMeasurement measure_crack(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                               const CrackMeasurementOptions &options)
{
  check(tip, breaks, options);

  CrackMeasurement m;
  m.X_begin = m.X_end = options.seed_tip_X;
  if (options.end_time == 0.)
  {
    m.reason = "the run was stopped before its first step";
    return m;
  }
  const double X_last = tip.empty() ? options.seed_tip_X : std::max(options.seed_tip_X, tip.back().X);
  const double advance = X_last - options.seed_tip_X;
  const double min_advance = 0.5 * options.arrest_fraction * options.strip_length;
  if (advance < min_advance && (tip.empty() || tip.back().t < 0.5 * options.end_time))
  {
    m.pattern = CrackPattern::arrested;
    m.reason = support::formatted("the tip advanced %.3g mm from the seed and stood for at least half of the run",
                                  1e3 * advance);
    return m;
  }
  if (advance < min_advance)
  {
    m.reason = support::formatted(
      "the tip has advanced %.3g mm from the seed and was still moving: too short to decide", 1e3 * advance);
    return m;
  }

  m.X_end = std::min(X_last, (1. - options.clamp_fraction) * options.strip_length);
  m.X_begin = std::min(m.X_end, options.seed_tip_X + options.run_in_fraction * options.strip_length);
  const SteadyPart steady_part = find_steady_part(tip, m.X_begin, m.X_end, options);
  m.X_begin = steady_part.X_begin;
  m.sinusoid = steady_part.sinusoid;
  if (m.sinusoid)
  {
    m.periods = (m.X_end - m.X_begin) / m.sinusoid->curve.wavelength;
    Measured &amplitude = m.sinusoid->amplitude;
    amplitude.uncertainty = std::hypot(amplitude.uncertainty, options.position_error * options.lattice_spacing);
  }
  const std::vector<TipRecord> steady = part_between(tip, m.X_begin, m.X_end);
  m.speed_lagrangian = steady_speed(steady, options.lattice_spacing, &TipRecord::X);
  m.speed_laboratory = steady_speed(steady, options.lattice_spacing, &TipRecord::x);
  m.branched_fraction =
    branched_fraction(breaks, options.seed_tip_X, m.X_end, options.lattice_spacing, options.branch_rule);
  if (m.X_begin < m.X_end)
    m.flanks = flank_damage(tip, breaks, m.X_begin, m.X_end, options.lattice_spacing);

  if (m.branched_fraction >= options.min_branched_fraction)
  {
    m.pattern = CrackPattern::branching;
    m.reason =
      support::formatted("the crack has two or more strands over %.0f %% of the crack", 100. * m.branched_fraction);
  }
  else if (stands_still(tip, options))
  {
    m.pattern = CrackPattern::arrested;
    m.reason = support::formatted("the tip stopped at X = %.3g mm, Y = %.3g mm, %.3g ms before the end of the run",
                                  1e3 * X_last, 1e3 * tip.back().Y, 1e3 * (options.end_time - tip.back().t));
  }
  else
    decide_oscillating_or_straight(m, steady_part.is_long_enough, options);
  if (m.wavelength)
  {
    m.crest_amplitude = crest_amplitude(steady, options.lattice_spacing, m.sinusoid->curve);
    if (m.crest_amplitude)
      m.crest_amplitude->uncertainty =
        std::hypot(m.crest_amplitude->uncertainty, options.position_error * options.lattice_spacing);
  }
  return m;
}

} // namespace latcon::analysis
