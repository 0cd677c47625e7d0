/// Output files and tables of a study.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "verification/study/study_table.h"

namespace latcon::study
{

/// Results of a study.
struct StudyResults
{
  Study study;
  std::vector<PlannedRun> plan;
  std::vector<RunOutcome> outcomes; ///< outcomes in the order of the plan
  std::vector<ClaimResult> claims;
  bool quick = false;
  std::string verification; ///< description of the verification
  bool is_verified = false; ///< material and pre-stretch of every run were verified
};

/// Returns the content of study.json: all data, for the page and for other programs. Equal runs give equal texts.
[[nodiscard]] std::string study_json(const StudyResults &results);

/// Returns the content of study.csv: a line per run and seed, units in the header, empty fields for quantities that
/// were not measured.
[[nodiscard]] std::string study_csv(const StudyResults &results);

/// Returns the rows that have a number or a rule in the common form of all commands. A row with a rule that was not
/// measured fails.
[[nodiscard]] output::Results study_rows(const StudyResults &results);

/// Prints the table, at most 120 columns wide.
void print_table(std::ostream &out, const StudyResults &results);

/// Prints the runs with their sizes and estimated time on `n_cores` cores.
void print_plan(std::ostream &out, const Study &study, const std::vector<PlannedRun> &plan, std::size_t n_cores);

} // namespace latcon::study
