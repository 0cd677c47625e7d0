/// Evaluation of the rows of a study: measured values and verdicts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "verification/output/results.h"
#include "verification/study/onset_fit.h"
#include "verification/study/run_outcome.h"
#include "verification/study/statistical_tests.h"
#include "verification/study/study_file.h"

namespace latcon::study
{

/// Verdict on a row, or on a claim.
enum class RowVerdict
{
  holds,
  does_not_hold,
  reported,     ///< the row has no rule
  not_measured, ///< too few seeds or runs have the quantity, or their scatter is unknown
  incomplete    ///< of a claim: some rows hold, others were not measured
};

/// Returns the name of a verdict: "holds", "does not hold", "reported", "not measured", "incomplete".
[[nodiscard]] std::string to_string(RowVerdict verdict);

/// Statistics of a quantity of one run over its seeds.
struct SeedStatistics
{
  std::string run;
  std::size_t n_seeds = 0;        ///< planned seeds
  std::size_t n = 0;              ///< seeds that have the quantity
  std::optional<double> abscissa; ///< value of the row's `against`

  std::optional<double> mean;      ///< none if n = 0 or for the pattern
  std::optional<double> deviation; ///< standard deviation over the seeds, n - 1; none if n < 2
  /// Root mean square of the uncertainties of single measurements, over seeds with an uncertainty; none if there are
  /// none.
  std::optional<double> uncertainty;
  std::map<std::string, std::size_t> patterns; ///< number of seeds per pattern, without "undecided"
  std::size_t n_undecided = 0;                 ///< seeds whose pattern is undecided
  std::size_t n_lost = 0;                      ///< seeds whose run was refused, rejected, failed, or not run
  std::vector<std::string> missing;            ///< "seed 3 failed", for each seed without the quantity

  /// Returns true if at least three quarters of the seeds have the quantity, as every rule requires. The mean is biased
  /// if seeds lack the quantity systematically: by 0.42 standard deviations without the lowest quarter of a normal
  /// distribution, by 0.80 without the lowest half.
  bool is_measured() const { return n > 0 && 4 * n >= 3 * n_seeds; }
  /// Returns true if more than a quarter of the seeds ended without a measurement. A run that is not lost may still
  /// lack the quantity, as a straight crack has no amplitude.
  bool is_lost() const { return 4 * n_lost > n_seeds; }
  /// Returns mean and scatter over the seeds, for tests. The run must have a mean.
  SampleMean sample() const;
  /// Returns true if the pattern is measured and all seeds with a pattern have this one.
  bool shows(const std::string &pattern) const;
  /// Describes the result: "2.29 ± 0.04 cm (5)", or "(4 of 5)" if a seed lacks the quantity; "oscillating 4/5,
  /// undecided 1/5", or "not measured".
  std::string text(const std::string &unit) const;
};

/// Judged row.
struct RowOutcome
{
  StudyRow row;
  std::optional<double> bound; ///< of rules with a bound; none if the run that gives it was not measured
  RowVerdict verdict = RowVerdict::not_measured;
  std::string expected;             ///< description of the rule; empty if there is none
  std::string measured;             ///< description of the result
  std::string note;                 ///< missing seeds and runs; empty if there are none
  std::vector<SeedStatistics> runs; ///< in the order of the row, or sorted by `against` if given
  std::optional<double> number;  ///< of the row as a whole: mean, share of seeds with the pattern, exponent, middle of
                                 ///< the bracket
  std::optional<OnsetFit> onset; ///< of `onset exponent`, if the curve could be fitted
  std::optional<double> misfit;  ///< the row holds if it is not larger than allowed(); none unless the row was judged
  /// Returns true if the rule is a statistical test, whose misfit is a p-value.
  bool is_test() const;
  /// Returns the largest misfit with which the row holds.
  double allowed() const;

  /// Returns the row for results.json, which fails if it has a rule and was not measured; none if the row has neither a
  /// number nor a rule.
  std::optional<output::Result> result(const std::string &claim) const;
};

/// Judged claim.
struct ClaimResult
{
  StudyClaim claim;
  std::vector<RowOutcome> rows;
  /// Returns `does_not_hold` if a row does not hold; otherwise `holds` if all rows with a rule hold, `not_measured` if
  /// none of them was measured, `incomplete` if some were; `reported` if no row has a rule.
  RowVerdict verdict() const;
};

/// Computes the statistics of one quantity over the seeds of a run.
[[nodiscard]] SeedStatistics statistics(const std::string &run, const std::string &quantity,
                                        const std::vector<RunOutcome> &outcomes);

/// Judges a row (docs/reference.md, "Studies").
/// @param plan runs, for the values of `against`
/// @param outcomes outcomes of these runs, in the same order
/// @param left_out runs that this size of the study omits
[[nodiscard]] RowOutcome judge(const StudyRow &row, const std::vector<PlannedRun> &plan,
                               const std::vector<RunOutcome> &outcomes, const std::vector<std::string> &left_out);

/// Judges all rows of a study.
[[nodiscard]] std::vector<ClaimResult> judge(const Study &study, const std::vector<PlannedRun> &plan,
                                             const std::vector<RunOutcome> &outcomes);

/// Formats a number with a readable unit: lengths in cm, areas in mm^2, times in ms.
/// @param deviation standard deviation in the same unit, or none
[[nodiscard]] std::string quantity_text(double value, std::optional<double> deviation, const std::string &unit);

} // namespace latcon::study
