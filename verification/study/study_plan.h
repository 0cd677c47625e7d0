/// The runs of a study, resolved: every case is checked before anything is run.
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

/// One fracture run: a case with one seed.
struct PlannedRun
{
  std::string run;
  std::uint64_t seed = 0;
  std::string case_text;                 ///< resolved, with every entry; the case.prm it will write
  double spacing = 0.;                   ///< d [m]
  std::optional<double> zeta;            ///< see zeta()
  std::map<std::string, double> entries; ///< those entries of the case that are numbers, in SI
  std::size_t sites = 0;
  double steps = 0.; ///< expected [-]: until a crack as fast as the shear waves of the unloaded sheet is through

  std::string folder() const { return run + "-" + std::to_string(seed); }
  double memory = 0.; ///< estimated, beyond that of the program itself [bytes]
  double cost() const { return static_cast<double>(sites) * steps; } ///< site-steps [-]
  /// Value of "zeta" or of an entry `Section/Name`; none if it has no number.
  std::optional<double> value(const std::string &against) const;
};

/// zeta = (eta / a) / (d / sqrt(a / rho)) of the nearest-neighbour bonds [-]: the retardation time over the time in
/// which a wave passes one spacing (theory.md, eq. (L.5)). None for linear bonds, which have no a.
[[nodiscard]] std::optional<double> zeta(const input::Case &input);

/// All runs of a study with all their seeds, in the order of the file. The noise seed is set here, and that there are
/// no frames but the first and the last.
/// @param base the file of the base case, read once: all runs are of the same
/// @param settings `Section/Name=value` for all runs, over those of the study
/// @throws InputError with the problems of every case, and of rows whose `against` has no number in any of their runs
[[nodiscard]] std::vector<PlannedRun> plan_runs(const Study &study, const input::InputFile &base,
                                                const std::vector<std::string> &settings);

/// Indices of the runs, the most expensive first; equal ones in their order.
[[nodiscard]] std::vector<std::size_t> longest_first(const std::vector<PlannedRun> &runs);

} // namespace latcon::study
