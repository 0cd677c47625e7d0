#pragma once

#include <optional>
#include <vector>

#include "verification/analysis/crack_records.h"
#include "verification/analysis/path_fit.h"

namespace latcon::analysis
{

struct CrackMeasurementOptions;

/// Steady part of a path and its fitted sinusoid.
struct SteadyPart
{
  double X_begin = 0.;                 ///< reference [m]
  bool is_long_enough = false;         ///< long enough to fit a sinusoid
  std::optional<SinusoidFit> sinusoid; ///< none if the part is too short or has no waviness, see fit_sinusoid()
};

/// Returns the records with X in [X_begin, X_end], reference [m].
std::vector<TipRecord> part_between(const std::vector<TipRecord> &tip, double X_begin, double X_end);

/// Fits a sinusoid to the path between X_begin and X_end (reference [m]) and moves the beginning to where the amplitude
/// over one wavelength has reached the later one; repeats this until the beginning no longer changes. At least two
/// wavelengths remain if there are two; a path without a clear sinusoid is not shortened.
SteadyPart find_steady_part(const std::vector<TipRecord> &tip, double X_begin, double X_end,
                            const CrackMeasurementOptions &rule);

/// Returns half the height from trough to crest [m], mean over the whole wavelengths of a path without its drift; the
/// uncertainty is that of the mean. The path is first averaged over columns of 2 d, so that a single hop is not a
/// crest.
/// @param tip records of the steady part
/// @param spacing d [m], > 0
/// @param curve sinusoid fitted to the path
/// @return none for fewer than two wavelengths, or if one contains no record
std::optional<Measured> crest_amplitude(const std::vector<TipRecord> &tip, double spacing, const Sinusoid &curve);

/// Returns the steady speed of a coordinate of the tip [m/s]: slope of the straight line through its position over
/// time.
///
/// The tip rests between records, so its mean position over equal time spans is known without interpolation, and every
/// span has the same weight.
/// @param tip records of the steady part, times and X not decreasing
/// @param spacing d [m], > 0
/// @param coordinate &TipRecord::X for the Lagrangian speed, &TipRecord::x for the laboratory speed
/// @return none for fewer than ten records, or if the tip or time does not advance
std::optional<Measured> steady_speed(const std::vector<TipRecord> &tip, double spacing, double TipRecord::*coordinate);

} // namespace latcon::analysis
