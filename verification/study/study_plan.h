/// Resolved runs of a study: all cases are checked before the first run starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "verification/input/input_file.h"
#include "verification/study/quantities.h"
#include "verification/study/study_file.h"

namespace latcon::input
{
struct Case;
}

namespace latcon::study
{

/// Fracture run: a case with one seed.
struct PlannedRun
{
  std::string run;
  std::uint64_t seed = 0;
  std::string case_text;                 ///< resolved case with all entries, as in the case.prm of the run
  double spacing = 0.;                   ///< d [m]
  std::optional<double> zeta;            ///< see zeta()
  std::map<std::string, double> entries; ///< numerical entries of the case, in SI units
  std::size_t sites = 0;
  double steps = 0.; ///< expected number, for a crack at the shear wave speed of the unloaded sheet

  std::string folder() const { return run + "-" + std::to_string(seed); }
  double memory = 0.; ///< estimated, in addition to that of the program itself [bytes]
  double cost() const { return static_cast<double>(sites) * steps; } ///< site-steps [-]
  /// Returns the value of "zeta" or of an entry `Section/Name`; none if it is not a number.
  std::optional<double> value(const std::string &against) const;
};

/// Returns zeta = (eta / a) / (d / sqrt(a / rho)) of the nearest-neighbour bonds [-]: the retardation time divided by
/// the travel time of a wave over one spacing (theory.md, eq. (L.5)). None for linear bonds, which have no a.
[[nodiscard]] std::optional<double> zeta(const input::Case &input);

/// Returns all runs of a study with all their seeds, in the order of the file. Sets the noise seed, and disables all
/// frames except the first and the last.
/// @param base file of the base case, read once for all runs
/// @param settings `Section/Name=value` for all runs; override those of the study
/// @throws InputError with the problems of all cases, and of rows whose `against` is not a number in any of their runs
[[nodiscard]] std::vector<PlannedRun> plan_runs(const Study &study, const input::InputFile &base,
                                                const std::vector<std::string> &settings);

/// Returns the indices of the runs in the order of decreasing cost; stable for equal cost.
[[nodiscard]] std::vector<std::size_t> longest_first(const std::vector<PlannedRun> &runs);

} // namespace latcon::study
