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
  rejected, ///< finished, but a row other than those about published values failed, as that of the energy ledger
  failed,   ///< ended with another exit code
  not_run   ///< the study was stopped before this run
};

/// Returns the name of a state in output files: "measured", "refused: verification", "failed its checks",
/// "failed", "not run".
[[nodiscard]] std::string to_string(RunState state);

/// Outcome of one run with one seed. Pattern, reason and values but zeta are empty unless the state is `measured`.
struct RunOutcome
{
  std::string run;
  std::uint64_t seed = 0;
  RunState state = RunState::not_run;
  int exit_code = 0;   ///< of the child process
  std::string problem; ///< of a refused or failed run: the last message it printed; of a rejected one: the rows
  std::string pattern; ///< one of pattern_words() or undecided_pattern
  std::string reason;
  Values values;
  double wall_time = 0.; ///< [s]
};

/// Reads crack.json and, if it exists, near_tip.json of a run that ended. A crack that ended is `measured`, with the
/// rows in `problem` that make it unfit as a measurement, if any.
/// @param folder, exit_code as for read_outcome()
[[nodiscard]] RunOutcome read_crack(const PlannedRun &run, const std::string &folder,
                                    std::optional<int> exit_code = {});

/// Reads the outcome of a run that ended, for statistics: a crack that is unfit as a measurement is `rejected`.
/// @param folder output directory of the run, with its output in log.txt
/// @param exit_code exit code of the process; empty: read it from run.json
[[nodiscard]] RunOutcome read_outcome(const PlannedRun &run, const std::string &folder,
                                      std::optional<int> exit_code = {});

/// Returns true if a folder contains a possibly unfinished run of exactly this case by exactly this program (equal
/// bytes), with the same choice of verification if it has recorded one.
[[nodiscard]] bool is_begun(const PlannedRun &run, const std::string &folder, bool skip_verification);

/// Returns true if a folder contains the run of exactly this case by exactly this program, with the same choice of
/// verification, and its crack ended: another run would end alike.
[[nodiscard]] bool is_finished(const PlannedRun &run, const std::string &folder, bool skip_verification);

} // namespace latcon::study
