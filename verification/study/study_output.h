/// What a study writes and prints.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "verification/study/study_check.h"
#include "verification/study/study_table.h"

namespace latcon::study
{

/// A study that was run.
struct StudyResults
{
  Study study;
  std::vector<PlannedRun> plan;
  std::vector<RunOutcome> outcomes; ///< of the plan, in its order
  std::vector<ClaimResult> claims;
  std::vector<CheckResult> checks; ///< those of the study, unless it was interrupted before
  bool quick = false;
  std::string verification; ///< what was verified, in words
  bool is_verified = false; ///< material and pre-stretch of every run were
};

/// study.json: everything, for the page and for other programs. The same runs give the same text.
[[nodiscard]] std::string study_json(const StudyResults &results);

/// study.csv: a line for each run and seed, units in the header, empty fields for what was not measured.
[[nodiscard]] std::string study_csv(const StudyResults &results);

/// The rows that have a number or a rule, in the form that all commands have, then those of the checks. A row holds
/// here if it does in the table; one that was to be judged and was not measured fails.
[[nodiscard]] output::Results study_rows(const StudyResults &results);

/// Prints the table, at most 120 columns wide.
void print_table(std::ostream &out, const StudyResults &results);

/// Prints the runs with their sizes and the estimated time on so many cores, and the checks beside them.
void print_plan(std::ostream &out, const Study &study, const std::vector<PlannedRun> &plan, std::size_t n_cores);

} // namespace latcon::study
