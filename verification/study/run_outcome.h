/// What a run of a study left in its folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "verification/study/quantities.h"
#include "verification/study/study_plan.h"

namespace latcon::study
{

/// How a run of a study came out.
enum class RunState
{
  measured, ///< it ran to its end and its crack was measured
  refused,  ///< its material or pre-stretch failed the verification
  failed,   ///< it ended otherwise, with another exit code
  not_run   ///< the study was stopped before
};

/// The word that outputs use: "measured", "refused: verification", "failed", "not run".
[[nodiscard]] std::string to_string(RunState state);

/// One run with one seed. Pattern and what was measured are empty unless the state is `measured`.
struct RunOutcome
{
  std::string run;
  std::uint64_t seed = 0;
  RunState state = RunState::not_run;
  int exit_code = 0;   ///< of the child process
  std::string problem; ///< of one that was refused or failed: the last line it printed
  std::string pattern; ///< "undecided" included
  std::string reason;
  Values values;
  double wall_time = 0.; ///< [s]
};

/// Reads crack.json and, if it is there, near_tip.json of a run that ended.
/// @param folder its output directory, with log.txt, what it printed
/// @param exit_code of the process; empty: the one that run.json says
[[nodiscard]] RunOutcome read_outcome(const PlannedRun &run, const std::string &folder,
                                      std::optional<int> exit_code = {});

/// Returns whether a folder holds a possibly unfinished run of exactly this case, by exactly this program (its bytes),
/// verified or not as asked.
[[nodiscard]] bool is_begun(const PlannedRun &run, const std::string &folder, bool skip_verification);

/// Returns whether a folder holds the measured run of exactly this case, by exactly this program, verified or not as
/// asked.
[[nodiscard]] bool is_finished(const PlannedRun &run, const std::string &folder, bool skip_verification);

} // namespace latcon::study
