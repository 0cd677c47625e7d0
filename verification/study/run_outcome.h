/// Outcome of a run of a study, as read from its folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "verification/study/quantities.h"
#include "verification/study/study_plan.h"

namespace latcon::study
{

/// State of a run of a study.
enum class RunState
{
  measured, ///< finished, and its crack was measured
  refused,  ///< material or pre-stretch failed the verification
  failed,   ///< ended with another exit code
  not_run   ///< the study was stopped before this run
};

/// Returns the name of a state in output files: "measured", "refused: verification", "failed", "not run".
[[nodiscard]] std::string to_string(RunState state);

/// Outcome of one run with one seed. Pattern, reason and values are empty unless the state is `measured`.
struct RunOutcome
{
  std::string run;
  std::uint64_t seed = 0;
  RunState state = RunState::not_run;
  int exit_code = 0;   ///< of the child process
  std::string problem; ///< of a refused or failed run: the last message it printed
  std::string pattern; ///< one of pattern_words() or undecided_pattern
  std::string reason;
  Values values;
  double wall_time = 0.; ///< [s]
};

/// Reads crack.json and, if it exists, near_tip.json of a run that ended.
/// @param folder output directory of the run, with its output in log.txt
/// @param exit_code exit code of the process; empty: read it from run.json
[[nodiscard]] RunOutcome read_outcome(const PlannedRun &run, const std::string &folder,
                                      std::optional<int> exit_code = {});

/// Returns true if a folder contains a possibly unfinished run of exactly this case by exactly this program (equal
/// bytes), with the same choice of verification if it has recorded one.
[[nodiscard]] bool is_begun(const PlannedRun &run, const std::string &folder, bool skip_verification);

/// Returns true if a folder contains the measured run of exactly this case by exactly this program, with the same
/// choice of verification.
[[nodiscard]] bool is_finished(const PlannedRun &run, const std::string &folder, bool skip_verification);

} // namespace latcon::study
