#pragma once

// Synthetic crack paths with known answers.
//
//   Y ^        path = drift + sinusoid + noise, moved to lattice sites as the tip of a simulation is
//     |  seed      _     _     _     clamp
//     |  ====-----/ \   / \   / \   -----|        strip L = 15 cm, d = 0.625 mm, seed to X = 0.1 L
//     |              \_/   \_/   \_/     |        window: from 0.2 L (or later) to 0.9 L
//     +----------------------------------+--> X

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "verification/analysis/crack_measurement.h"

namespace synthetic_crack
{

using latcon::analysis::BreakRecord;
using latcon::analysis::CrackMeasurement;
using latcon::analysis::CrackMeasurementOptions;
using latcon::analysis::CrackPattern;
using latcon::analysis::measure_crack;
using latcon::analysis::TipRecord;

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double length = 0.15;
inline constexpr double d = 0.625e-3;
inline constexpr double seed_tip = 0.015;
inline constexpr double speed = 20.;
inline constexpr double stretch_x = 2.3;

inline constexpr double wavelength = 0.023;
inline constexpr double amplitude = 0.0017;

using Path = std::function<double(double)>;

inline Path sinusoid(double lambda, double a, double phase = 0.7)
{
  return [=](double X) { return a * std::sin(2. * pi * X / lambda + phase); };
}

inline double straight(double)
{
  return 0.;
}

struct SyntheticCrack
{
  Path path = straight;
  double hops = 0.;              // independent noise of Y [m]
  double wander = 0.;            // noise of Y, correlated over `memory` [m]
  double memory = 5. * d;        // [m]
  double walk = 0.;              // random walk: rms of a step over one d [m]
  double slowness_noise = 0.;    // relative, correlated over 8 d
  double X_last = 0.98 * length; // [m]
  bool on_sites = true;          // rounded to the nearest site of the column
  bool skips_columns = true;     // irregular steps of the tip

  std::vector<TipRecord> record(unsigned int seed) const
  {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    std::discrete_distribution<int> skipped({60, 25, 12, 0, 0, 3});
    std::vector<TipRecord> tip;
    double t = 0., wandered = wander * normal(generator), walked = 0., slowness = 0.;
    for (int column = static_cast<int>(std::lround(seed_tip / (0.5 * d))) + 1;; ++column)
    {
      const int step = 1 + (skips_columns ? skipped(generator) : 0);
      column += step - 1;
      const double X = 0.5 * d * column;
      if (X > X_last)
        return tip;
      const double dX = 0.5 * d * step;
      const auto remember = [&](double value, double rms, double distance)
      {
        const double kept = std::exp(-dX / distance);
        return kept * value + rms * std::sqrt(1. - kept * kept) * normal(generator);
      };
      wandered = remember(wandered, wander, memory);
      walked += walk * std::sqrt(dX / d) * normal(generator);
      slowness = remember(slowness, slowness_noise, 8. * d);
      t += dX / speed * std::max(0.05, 1. + slowness);
      double Y = path(X) + hops * normal(generator) + wandered + walked;
      if (on_sites)
      {
        const double row_pitch = 0.5 * std::sqrt(3.) * d;
        const int parity = column % 2;
        Y = row_pitch * (2. * std::round(0.5 * (Y / row_pitch - parity)) + parity);
      }
      // The tip retracts: in the laboratory frame it is at a constant distance behind its position in the intact sheet.
      tip.push_back({t, X, Y, stretch_x * X - 0.004, 2.8 * Y});
    }
  }
};

/// Returns the options of a run that ended with the last entry of the record.
inline CrackMeasurementOptions options_for(const std::vector<TipRecord> &tip)
{
  CrackMeasurementOptions options;
  options.strip_length = length;
  options.lattice_spacing = d;
  options.end_time = tip.empty() ? 1e-3 : tip.back().t;
  options.seed_tip_X = seed_tip;
  return options;
}

inline CrackMeasurement measure(const SyntheticCrack &crack, unsigned int seed = 1,
                                const std::vector<BreakRecord> &breaks = {})
{
  const std::vector<TipRecord> tip = crack.record(seed);
  return measure_crack(tip, breaks, options_for(tip));
}

/// Adds six broken bonds per d, as for a crack through nearest and next-nearest neighbours, uniformly within
/// `half_width` on both sides of a path.
inline void break_along(std::vector<BreakRecord> &breaks, const Path &path, double X_begin, double X_end,
                        double half_width = d)
{
  const double step = d / 6.;
  int i = 0;
  for (double X = X_begin; X < X_end; X += step, ++i)
    breaks.push_back({(X - seed_tip) / speed, X, path(X) + half_width * ((i * 5) % 12 - 5.5) / 5.5});
}

} // namespace synthetic_crack
