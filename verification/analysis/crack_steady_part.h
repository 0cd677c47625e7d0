#pragma once

#include <optional>
#include <vector>

#include "verification/analysis/crack_records.h"
#include "verification/analysis/path_fit.h"

namespace latcon::analysis
{

/// How the steady part of an oscillating path is told.
struct SteadyPartRule
{
  double lattice_spacing;   ///< d [m], > 0
  double min_wavelength;    ///< shortest wavelength looked for, in d
  double settled_amplitude; ///< part of the later amplitude at which an oscillation has settled [-], in (0, 1)
};

/// Steady part of a path and the sinusoid nearest to it.
struct SteadyPart
{
  double X_begin = 0.;                 ///< reference [m]
  bool is_long_enough = false;         ///< whether a sinusoid can be fitted at all
  std::optional<SinusoidFit> sinusoid; ///< none where the part is too short or has no waviness, see fit_sinusoid()
};

/// Records with X in [X_begin, X_end], reference [m].
std::vector<TipRecord> part_between(const std::vector<TipRecord> &tip, double X_begin, double X_end);

/// Fits a sinusoid to the path between X_begin and X_end (reference [m]) and moves the beginning to where the amplitude
/// over one wavelength has come to the later one, until fit and beginning agree. Two wavelengths stay where there are
/// two; a path without a clear sinusoid stays whole.
SteadyPart find_steady_part(const std::vector<TipRecord> &tip, double X_begin, double X_end,
                            const SteadyPartRule &rule);

/// Half the height from trough to crest, mean over the whole wavelengths of a path, its drift taken off [m]; the
/// uncertainty is that of the mean. The path is averaged over columns of 2 d first, so that a single hop is no crest.
/// @param tip records of the steady part
/// @param spacing d [m], > 0
/// @param curve the sinusoid nearest to the path
/// @return none for fewer than two wavelengths, or where one holds no record
std::optional<Measured> crest_amplitude(const std::vector<TipRecord> &tip, double spacing, const Sinusoid &curve);

/// Steady speed of a coordinate of the tip [m/s]: slope of the straight line through its position over time.
///
/// The tip rests between records, so its mean position over equal spans of time is known without interpolation, and
/// every span has the same weight.
/// @param tip records of the steady part, times and X not decreasing
/// @param spacing d [m], > 0
/// @param coordinate &TipRecord::X for the Lagrangian speed, &TipRecord::x for the one in the laboratory
/// @return none for fewer than ten records, or if the tip or time does not advance
std::optional<Measured> steady_speed(const std::vector<TipRecord> &tip, double spacing, double TipRecord::*coordinate);

} // namespace latcon::analysis
