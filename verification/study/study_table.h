/// The table of a study: what each row measured, and whether it holds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "verification/output/results.h"
#include "verification/study/run_outcome.h"
#include "verification/study/statistical_tests.h"
#include "verification/study/study_file.h"

namespace latcon::study
{

/// Verdict of a row, or of a claim.
enum class RowVerdict
{
  holds,
  does_not_hold,
  reported,     ///< the row has no rule
  not_measured, ///< too few seeds or runs have what the rule needs, or their scatter is unknown
  incomplete    ///< of a claim: rows hold, and others were not measured
};

/// "holds", "does not hold", "reported", "not measured", "incomplete".
[[nodiscard]] std::string to_string(RowVerdict verdict);

/// A quantity of one run over its seeds.
struct SeedStatistics
{
  std::string run;
  std::size_t n_seeds = 0;        ///< that were to be run
  std::size_t n = 0;              ///< that have the quantity
  std::optional<double> abscissa; ///< value of the row's `against`

  std::optional<double> mean;      ///< none if n = 0 or for the pattern
  std::optional<double> deviation; ///< standard deviation over the seeds, n - 1; none if n < 2
  /// Root mean square of the uncertainties of the single measurements, of seeds that give one; none if none does.
  std::optional<double> uncertainty;
  std::map<std::string, std::size_t> patterns; ///< how many seeds showed each; none of them "undecided"
  std::size_t n_undecided = 0;                 ///< seeds whose pattern is undecided: these have none
  std::vector<std::string> missing;            ///< "seed 3 failed", for each seed without the quantity

  /// Returns whether at least three quarters of the seeds have the quantity, as every rule requires. A mean over those
  /// that have it is biased if the others lack it for a reason: without the lowest quarter of a normal distribution by
  /// 0.42 standard deviations, without the lowest half by 0.80.
  bool is_measured() const { return n > 0 && 4 * n >= 3 * n_seeds; }
  /// Mean and scatter over the seeds, for tests. The run must have a mean.
  SampleMean sample() const;
  /// Whether it is measured, and all seeds that have a pattern have this one.
  bool shows(const std::string &pattern) const;
  /// "2.29 ± 0.04 cm (5)", or "(4 of 5)" if a seed lacks it; "oscillating 4/5, undecided 1/5", or "not measured".
  std::string text(const std::string &unit) const;
};

/// A row, judged.
struct RowOutcome
{
  StudyRow row;
  std::optional<double> bound; ///< of the rules that have one; none if the run that gives it was not measured
  RowVerdict verdict = RowVerdict::not_measured;
  std::string expected;             ///< the rule in words; empty if there is none
  std::string measured;             ///< what came out, in words
  std::string note;                 ///< seeds and runs that are missing; empty if none is
  std::vector<SeedStatistics> runs; ///< in the order of the row, or of `against` if it has one
  std::optional<double> number; ///< of the row as a whole: mean, share of seeds with the pattern, exponent, middle of
                                ///< the bracket
  std::optional<double> misfit; ///< holds if not larger than allowed(); none unless the row was judged
  /// Returns whether the rule is a statistical test, whose misfit is a p-value.
  bool is_test() const;
  /// Largest misfit with which the row holds.
  double allowed() const;

  /// As a row of results.json, which fails if it was to be judged and was not measured; none if the row has no number
  /// and no rule.
  std::optional<output::Result> result(const std::string &claim) const;
};

/// A claim, judged.
struct ClaimResult
{
  StudyClaim claim;
  std::vector<RowOutcome> rows;
  /// "does not hold" if a row does not; else "holds" if all that were to be judged do, "not measured" if none of them
  /// was, "incomplete" if some were; "reported" if no row was to be judged.
  RowVerdict verdict() const;
};

/// Statistics of one quantity over the seeds of a run.
[[nodiscard]] SeedStatistics statistics(const std::string &run, const std::string &quantity,
                                        const std::vector<RunOutcome> &outcomes);

/// Judges a row (docs/reference.md, "Studies").
/// @param plan the runs, for the values of `against`
/// @param outcomes of these runs, in the same order
/// @param left_out runs that this size of the study does without
[[nodiscard]] RowOutcome judge(const StudyRow &row, const std::vector<PlannedRun> &plan,
                               const std::vector<RunOutcome> &outcomes, const std::vector<std::string> &left_out);

/// Judges all rows of a study.
[[nodiscard]] std::vector<ClaimResult> judge(const Study &study, const std::vector<PlannedRun> &plan,
                                             const std::vector<RunOutcome> &outcomes);

/// A number with its unit as a reader wants it: lengths in cm, areas in mm^2, times in ms.
/// @param deviation standard deviation in the same unit, or none
[[nodiscard]] std::string quantity_text(double value, std::optional<double> deviation, const std::string &unit);

} // namespace latcon::study
