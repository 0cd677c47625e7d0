/// Checks that belong to no run of a study: the simulator against solutions that are known.
#pragma once

#include <string>
#include <vector>

#include "verification/claims/claim_outcome.h"

namespace latcon::study
{

/// A check that a study file can ask for.
struct StudyCheck
{
  std::string name;
  std::string about; ///< what is held against what, in a few sentences
  claims::ClaimOutcome (*run)(bool quick);
};

/// All of them.
[[nodiscard]] const std::vector<StudyCheck> &study_checks();

/// What a check found.
struct CheckResult
{
  std::string name;
  std::string about;
  output::Results rows;
};

/// Runs a check on one thread and writes its tables into `folder`.
/// @throws std::logic_error for a name that is none; OutputError
[[nodiscard]] CheckResult run_check(const std::string &name, bool quick, const std::string &folder);

} // namespace latcon::study
