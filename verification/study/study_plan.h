/// Resolved runs of a study: all cases are checked before the first run starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
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

/// Case of a run, shared by its seeds. It is resolved once, whatever their number.
struct PlannedCase
{
  std::shared_ptr<const input::InputFile> base;         ///< shared by all cases of a study
  std::string base_name;                                ///< path of the base case
  std::vector<std::string> changes;                     ///< `Section/Name=value` without the seed
  std::shared_ptr<const std::vector<std::string>> keys; ///< all entries `Section/Name`, sorted; shared by all cases
  std::vector<double> numbers;              ///< values of `keys` in SI units; NaN for entries that are not numbers
  std::map<std::string, std::string> texts; ///< other values, of the entries that a run of the study changes
  bool on_continuum = false;                ///< true: the finite elements break, not the lattice
};

/// Fracture run: a case with one seed. It keeps no text of its case, so that thousands of runs take little memory.
struct PlannedRun
{
  std::string run;
  std::uint64_t seed = 0;
  std::shared_ptr<const PlannedCase> planned_case; ///< shared by the seeds of the run
  std::string case_sha256;    ///< of all entries and their values, as in Parameters::lines(); hexadecimal
  double spacing = 0.;        ///< d [m]
  std::optional<double> zeta; ///< see zeta()
  double size = 0.;           ///< number of sites, or of cells
  /// Number of evaluations of the forces: for a crack of the lattice at the shear wave speed of the unloaded sheet, for
  /// one of the finite elements until the end time.
  double evaluations = 0.;
  double seconds = 0.; ///< estimated time on one core [s]

  /// Resolves the case with all entries, as in the case.prm of the run.
  [[nodiscard]] std::string case_text() const;
  std::string folder() const { return run + "-" + std::to_string(seed); }
  double memory = 0.; ///< estimated, in addition to that of the program itself [bytes]
  /// Side that breaks, as in crack.json.
  std::string side() const { return planned_case != nullptr && planned_case->on_continuum ? "continuum" : "lattice"; }
  /// Returns the value of "zeta" or of an entry `Section/Name`; none if it is not a number.
  std::optional<double> value(const std::string &against) const;
  /// Returns the value of an entry that a run of the study changes, if it is not a number; empty if it is one.
  std::string text(const std::string &key) const;
};

/// Returns zeta = (eta / a) / (d / sqrt(a / rho)) of the nearest-neighbour bonds [-]: the retardation time divided by
/// the travel time of a wave over one spacing (theory.md, eq. (L.5)). None for linear bonds, which have no a.
[[nodiscard]] std::optional<double> zeta(const input::Case &input);

/// Splits settings `Section/Name=value` of the command line; cases check names and values when they read them.
/// @throws InputError for other texts, and for the seed
[[nodiscard]] Settings parse_settings(const std::vector<std::string> &texts);

/// Cases of a study whose claims are checked before its cracks run. Their user-defined laws need values at all
/// stretches at which claims evaluate them.
enum class Verification
{
  none,      ///< --skip-verification
  base_case, ///< --quick
  every_run
};

/// Returns all runs of a study with all their seeds, in the order of the file. Sets the noise seed, and disables all
/// frames except the first and the last.
/// @param base file of the base case, read once for all runs
/// @param settings `Section/Name=value` for all runs; override those of the study
/// @throws InputError with the problems of all cases, of rows whose `against` is not a number in any of their runs, and
/// of settings of entries that the study sweeps
[[nodiscard]] std::vector<PlannedRun> plan_runs(const Study &study, const input::InputFile &base,
                                                const std::vector<std::string> &settings,
                                                Verification verification = Verification::every_run);

/// Returns the base case with the settings of all runs, for claims that are checked on it alone.
/// @param base file of the base case
/// @param settings `Section/Name=value`; override those of the study
/// @throws InputError with its problems, user-defined laws included that have no values for the claims
[[nodiscard]] input::Case base_case(const Study &study, const input::InputFile &base,
                                    const std::vector<std::string> &settings);

/// Returns the indices of the runs in the order of decreasing time; stable for equal times.
[[nodiscard]] std::vector<std::size_t> longest_first(const std::vector<PlannedRun> &runs);

} // namespace latcon::study
