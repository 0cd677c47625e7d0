/// Checks of the simulator against known solutions, independent of the runs of a study.
#pragma once

#include <string>
#include <vector>

#include "verification/claims/claim_outcome.h"

namespace latcon::study
{

/// Check that a study file can request.
struct StudyCheck
{
  std::string name;
  std::string about; ///< description in a few sentences
  claims::ClaimOutcome (*run)(bool quick);
};

/// Returns all checks.
[[nodiscard]] const std::vector<StudyCheck> &study_checks();

/// Result of a check.
struct CheckResult
{
  std::string name;
  std::string about;
  output::Results rows;
};

/// Runs a check on one thread and writes its tables into `folder`.
/// @throws std::logic_error if there is no such check; OutputError
[[nodiscard]] CheckResult run_check(const std::string &name, bool quick, const std::string &folder);

} // namespace latcon::study
