// Rules of a study on artificial values, each with both outcomes, and notes on seeds and runs without a value.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "verification/study/study_output.h"

namespace study_table_test
{

using namespace latcon;
using namespace output;
using namespace study;

// Runs with values along zeta = 1, 2, 3 ... in the order in which they were added.
class MadeUpStudy
{
public:
  // Adds seeds of a run with values of the wavelength [m]; NaN: straight, no wavelength.
  void add(const std::string &run, const std::vector<double> &wavelengths)
  {
    for (const double wavelength : wavelengths)
    {
      RunOutcome &outcome = add_seed(run, std::isnan(wavelength) ? "straight" : "oscillating");
      if (!std::isnan(wavelength))
        outcome.values["wavelength"] = wavelength;
    }
  }

  RunOutcome &add_seed(const std::string &run, const std::string &pattern)
  {
    const bool known = !plan.empty() && plan.back().run == run;
    PlannedRun planned;
    planned.run = run;
    planned.seed = known ? plan.back().seed + 1 : 1;
    planned.zeta = known ? *plan.back().zeta : plan.empty() ? 1. : *plan.back().zeta + 1.;
    plan.push_back(planned);
    RunOutcome outcome;
    outcome.run = run;
    outcome.seed = planned.seed;
    outcome.state = RunState::measured;
    outcome.pattern = pattern;
    outcomes.push_back(outcome);
    return outcomes.back();
  }

  RowOutcome judged(const StudyRow &row, const std::vector<std::string> &left_out = {}) const
  {
    return judge(row, plan, outcomes, left_out);
  }

  std::vector<PlannedRun> plan;
  std::vector<RunOutcome> outcomes;
};

StudyRow row_of(const std::vector<std::string> &runs, Rule rule, double bound = 0., double tolerance = 0.)
{
  StudyRow row;
  row.runs = runs;
  row.quantity = "wavelength";
  row.rule = rule;
  row.bound = bound;
  row.tolerance = tolerance;
  if (rule == Rule::rises || rule == Rule::falls)
    row.against = "zeta";
  return row;
}

StudyRow pattern_row(const std::vector<std::string> &runs, const std::string &pattern)
{
  StudyRow row = row_of(runs, Rule::is);
  row.quantity = pattern_quantity;
  row.pattern = pattern;
  return row;
}

StudyRow bracket_row(const std::vector<std::string> &runs)
{
  StudyRow row = pattern_row(runs, "");
  row.rule = Rule::bracket;
  row.from = "straight";
  row.to = "oscillating";
  row.against = "zeta";
  return row;
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(StudyTable, MeanAndStandardDeviationOverSeeds)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.022, 0.024});
  const SeedStatistics seeds = statistics("a", "wavelength", table.outcomes);
  EXPECT_DOUBLE_EQ(seeds.mean.value(), 0.022);
  EXPECT_NEAR(seeds.deviation.value(), 0.002, 1e-15);
  EXPECT_NEAR(seeds.sample().variance, 4e-6, 1e-18);
  EXPECT_EQ(seeds.text("m"), "2.20 ± 0.20 cm (3)");
}

TEST(StudyTable, EqualValuesHaveNoDeviation)
{
  MadeUpStudy table;
  table.add("a", std::vector<double>(10, 0.02));
  EXPECT_EQ(statistics("a", "wavelength", table.outcomes).text("m"), "2 cm (10)");
}

// Over seeds with an uncertainty only.
TEST(StudyTable, UncertaintyIsTheRootMeanSquareOverTheSeedsThatGiveOne)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.021, 0.022});
  EXPECT_FALSE(statistics("a", "wavelength", table.outcomes).uncertainty.has_value());
  table.outcomes[0].values["wavelength_uncertainty"] = 0.003;
  table.outcomes[1].values["wavelength_uncertainty"] = 0.004;
  const SeedStatistics seeds = statistics("a", "wavelength", table.outcomes);
  EXPECT_NEAR(seeds.uncertainty.value(), std::sqrt(12.5e-6), 1e-15);
  EXPECT_NEAR(seeds.sample().floored_variance(), 12.5e-6, 1e-18); // the spread is 0.001
}

TEST(StudyTable, IsNearHoldsWithinItsTolerance)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.022});
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::is_near, 0.0229, 0.1)).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::is_near, 0.0229, 0.08)).verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::is_near, 0.0195, 0.07)).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, AboveAndBelow)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.022});
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::above, 0.0209)).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::above, 0.0211)).verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::below, 0.0211)).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(row_of({"a"}, Rule::below, 0.0209)).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, BoundMayBeThatOfAnotherRun)
{
  MadeUpStudy table;
  table.add("a", {0.020, 0.021, 0.022});
  table.add("b", {0.030, 0.031, 0.032});
  table.add("none", {NAN});
  StudyRow row = row_of({"a"}, Rule::below);
  row.bound_run = "b";
  const RowOutcome below = table.judged(row);
  EXPECT_EQ(below.verdict, RowVerdict::holds);
  EXPECT_NEAR(below.misfit.value(), 1.28e-4, 1e-6); // t = 12.25 with 4 degrees of freedom
  EXPECT_HAS(below.measured, "p = 0.0001");
  EXPECT_HAS(below.expected, "below that of b (3.1 cm)");
  row.rule = Rule::above;
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::does_not_hold);
  row.bound_run = "none";
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::not_measured);
  EXPECT_HAS(table.judged(row).note, "none, the run to compare with");
}

// A difference within the scatter of the seeds is not significant; without a scatter nothing is.
TEST(StudyTable, ARunBesideAnotherMustDifferClearly)
{
  MadeUpStudy table;
  table.add("a", {0.018, 0.022});
  table.add("b", {0.019, 0.025});
  table.add("one", {0.9});
  table.add("same", {0.9, 0.9});
  StudyRow row = row_of({"a"}, Rule::below);
  row.bound_run = "b";
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::does_not_hold);
  row.bound_run = "one";
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::not_measured);
  EXPECT_HAS(table.judged(row).note, "a compared with one: the scatter of the seeds is unknown");
  row.runs = {"same"};
  row.rule = Rule::above;
  row.bound_run = "same";
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::not_measured);
  // All runs must be on the required side.
  table.add("c", {0.0100, 0.0101, 0.0102, 0.0103});
  row = row_of({"c", "a"}, Rule::below);
  row.bound_run = "b";
  EXPECT_EQ(table.judged(row).verdict, RowVerdict::does_not_hold);
}

// 0 / 0: relative distance from zero.
TEST(StudyTable, WhatIsNoNumberDoesNotHold)
{
  MadeUpStudy table;
  table.add("a", {0., 0.});
  table.add("b", {0.02, 0.02});
  StudyRow row = row_of({"a", "b"}, Rule::is_near, 0., 0.1);
  row.bound_run = "a";
  const RowOutcome outcome = table.judged(row);
  EXPECT_EQ(outcome.verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(outcome.result("c").value().verdict(), Verdict::fails);
}

TEST(StudyTable, ARuleForEachRunWantsAllOfThem)
{
  MadeUpStudy table;
  table.add("a", {0.02});
  table.add("b", {0.03});
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::above, 0.01)).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::above, 0.025)).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, PatternHoldsIfEverySeedShowsIt)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.02, 0.02});
  EXPECT_EQ(table.judged(pattern_row({"a"}, "oscillating")).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(pattern_row({"a"}, "oscillating")).measured, "oscillating 3/3");
  table.outcomes[1].pattern = "straight";
  const RowOutcome mixed = table.judged(pattern_row({"a"}, "oscillating"));
  EXPECT_EQ(mixed.verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(mixed.measured, "oscillating 2/3, straight 1/3");
  EXPECT_NEAR(mixed.number.value(), 2. / 3., 1e-15);
}

TEST(StudyTable, UndecidedPatternsDoNotCount)
{
  MadeUpStudy table;
  table.add("a", {0.02, 0.02, 0.02, 0.02});
  table.outcomes[2].pattern = "undecided";
  const RowOutcome one = table.judged(pattern_row({"a"}, "oscillating"));
  EXPECT_EQ(one.verdict, RowVerdict::holds);
  EXPECT_EQ(one.measured, "oscillating 3/4, undecided 1/4");
  EXPECT_HAS(one.note, "a: not measured in 1 of 4 (seed 3 undecided)");
  table.outcomes[1].pattern = "undecided";
  EXPECT_EQ(table.judged(pattern_row({"a"}, "oscillating")).verdict, RowVerdict::not_measured);
}

TEST(StudyTable, SeedsWithoutTheNumberAreNamedAndMoreThanAQuarterAreTooMany)
{
  MadeUpStudy table;
  table.add("a", {0.02, NAN, 0.022, 0.021});
  const RowOutcome some = table.judged(row_of({"a"}, Rule::is_near, 0.021, 0.1));
  EXPECT_EQ(some.verdict, RowVerdict::holds);
  EXPECT_HAS(some.measured, "cm (3 of 4)");
  EXPECT_EQ(some.note, "a: not measured in 1 of 4 (seed 2 straight)");
  RunOutcome &failed = table.add_seed("a", "");
  failed.state = RunState::failed;
  const RowOutcome more = table.judged(row_of({"a"}, Rule::is_near, 0.021, 0.1));
  EXPECT_EQ(more.verdict, RowVerdict::not_measured);
  EXPECT_HAS(more.note, "seed 5 failed");
  EXPECT_EQ(more.result("c").value().verdict(), Verdict::fails);
}

// A claim holds only if all its rows hold.
TEST(StudyTable, AClaimWithARowThatWasNotMeasuredIsIncomplete)
{
  const auto verdict = [](const std::vector<RowVerdict> &rows)
  {
    ClaimResult claim;
    for (const RowVerdict row : rows)
    {
      claim.rows.emplace_back();
      claim.rows.back().verdict = row;
    }
    return claim.verdict();
  };
  using V = RowVerdict;
  EXPECT_EQ(verdict({V::holds, V::reported}), V::holds);
  EXPECT_EQ(verdict({V::holds, V::not_measured, V::reported}), V::incomplete);
  EXPECT_EQ(verdict({V::not_measured, V::reported}), V::not_measured);
  EXPECT_EQ(verdict({V::holds, V::not_measured, V::does_not_hold}), V::does_not_hold);
  EXPECT_EQ(verdict({V::reported}), V::reported);
  EXPECT_EQ(to_string(V::incomplete), "incomplete");
}

TEST(StudyTable, RisesAndFalls)
{
  MadeUpStudy table;
  table.add("a", {0.010, 0.011});
  table.add("b", {0.020, 0.021});
  table.add("c", {0.0205, 0.0206}); // saturated
  const RowOutcome rises = table.judged(row_of({"c", "a", "b"}, Rule::rises));
  EXPECT_EQ(rises.verdict, RowVerdict::holds);
  EXPECT_HAS(rises.measured, "rise: p = 0.00");
  EXPECT_HAS(rises.measured, "a fall in between: p = 1");
  const RowOutcome falls = table.judged(row_of({"c", "a", "b"}, Rule::falls));
  EXPECT_EQ(falls.verdict, RowVerdict::does_not_hold);
  EXPECT_HAS(falls.measured, "fall: p = 1");
  table.add("d", {0.012, 0.013}); // above the first, but significantly below the others
  const RowOutcome broken = table.judged(row_of({"a", "b", "c", "d"}, Rule::rises));
  EXPECT_EQ(broken.verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(broken.misfit, 1.);
  EXPECT_HAS(broken.measured, "clearly from 2 to 4");
}

// With one seed per run the scatter is unknown for any number of runs, so no difference is significant.
TEST(StudyTable, NoTrendIsMeasuredWithoutAScatterOfSeeds)
{
  MadeUpStudy table;
  table.add("a", {0.01});
  table.add("b", {0.02});
  table.add("c", {0.03});
  for (RunOutcome &outcome : table.outcomes)
    outcome.values["wavelength_uncertainty"] = 1e-4; // of the measurement, not scatter of the cracks
  const RowOutcome single = table.judged(row_of({"a", "b", "c"}, Rule::rises));
  EXPECT_EQ(single.verdict, RowVerdict::not_measured);
  EXPECT_HAS(single.note, "the scatter of the seeds is unknown");
  table.add("d", {0.05, 0.05}); // identical seeds give no scatter either
  EXPECT_EQ(table.judged(row_of({"a", "b", "c", "d"}, Rule::rises)).verdict, RowVerdict::not_measured);
  table.add("e", {0.0500, 0.0501, 0.0502});
  EXPECT_EQ(table.judged(row_of({"a", "b", "c", "d", "e"}, Rule::rises)).verdict, RowVerdict::holds);
}

// Two seeds that agree by chance must not make a difference below the measurement uncertainty significant.
TEST(StudyTable, ScatterIsNotBelowTheUncertaintyOfAMeasurement)
{
  MadeUpStudy table;
  table.add("a", {0.0200, 0.0201});
  table.add("b", {0.0210, 0.0211});
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::rises)).verdict, RowVerdict::holds);
  for (RunOutcome &outcome : table.outcomes)
    outcome.values["wavelength_uncertainty"] = 0.002;
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::rises)).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, NoRiseThatIsWithinTheErrors)
{
  MadeUpStudy table;
  table.add("a", {0.010, 0.020});
  table.add("b", {0.012, 0.022});
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::rises)).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, ExponentOfATrend)
{
  MadeUpStudy table;
  for (const double zeta : {1., 2., 3., 4.})
    table.add("z" + std::to_string(int(zeta)), {0.0099 * std::sqrt(zeta), 0.0101 * std::sqrt(zeta)});
  const RowOutcome row = table.judged(row_of({"z1", "z2", "z3", "z4"}, Rule::rises));
  EXPECT_NEAR(row.number.value(), 0.5, 1e-12);
}

// Means 0.01 m (zeta - 0.9)^exponent at zeta = 1 to 6, with a scatter of 0.0001 m, and a straight crack before them.
MadeUpStudy above_onset(double exponent, double scatter = 1e-4)
{
  MadeUpStudy table;
  for (int i = 1; i <= 6; ++i)
  {
    const double mean = 0.01 * std::pow(i - 0.9, exponent);
    table.add("z" + std::to_string(i), {mean - scatter, mean + scatter, mean});
  }
  table.add("straight", {NAN, NAN, NAN});
  return table;
}

StudyRow onset_row(double exponent, double tolerance)
{
  StudyRow row = row_of({"straight", "z1", "z2", "z3", "z4", "z5", "z6"}, Rule::onset_exponent, exponent, tolerance);
  row.against = "zeta";
  return row;
}

TEST(StudyTable, OnsetExponentNeedsAnIntervalWithinItsTolerance)
{
  const RowOutcome holds = above_onset(0.5).judged(onset_row(0.5, 0.2));
  EXPECT_EQ(holds.verdict, RowVerdict::holds);
  EXPECT_NEAR(holds.number.value(), 0.5, 1e-6);
  EXPECT_NEAR(holds.onset.value().onset.value, 0.9, 1e-6);
  EXPECT_EQ(holds.allowed(), 0.2);
  EXPECT_HAS(holds.measured, "exponent 0.5 (0.4");
  EXPECT_HAS(holds.measured, "onset at 0.9 (0.8");
  EXPECT_EQ(holds.expected, "rises above an onset with an exponent of 0.5 ± 0.2");
  EXPECT_HAS(holds.note, "straight: not measured in 3 of 3");
  EXPECT_EQ(above_onset(1.).judged(onset_row(0.5, 0.2)).verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(above_onset(0.25).judged(onset_row(0.5, 0.2)).verdict, RowVerdict::does_not_hold);

  const RowOutcome wide = above_onset(0.5, 3e-3).judged(onset_row(0.5, 0.2));
  EXPECT_EQ(wide.verdict, RowVerdict::not_measured);
  EXPECT_HAS(wide.note, "too wide to tell");
  StudyRow few = onset_row(0.5, 0.2);
  few.runs.resize(5); // four above the onset
  const RowOutcome none = above_onset(0.5).judged(few);
  EXPECT_EQ(none.verdict, RowVerdict::not_measured);
  EXPECT_FALSE(none.onset);
  EXPECT_HAS(none.note, "five runs");
}

TEST(StudyTable, TrendLeavesOutRunsWithoutTheNumberAndSaysSo)
{
  MadeUpStudy table;
  table.add("a", {NAN, NAN});
  table.add("b", {0.020, 0.021});
  table.add("c", {0.030, 0.031});
  const RowOutcome row = table.judged(row_of({"a", "b", "c"}, Rule::rises));
  EXPECT_EQ(row.verdict, RowVerdict::holds);
  EXPECT_HAS(row.note, "a: not measured in 2 of 2");
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::rises)).verdict, RowVerdict::not_measured);
}

// Straight cracks have no wavelength; of runs that were lost nothing is known.
TEST(StudyTable, NothingIsSaidAlongRunsThatWereLost)
{
  MadeUpStudy table;
  table.add("a", {NAN, NAN, NAN, NAN});
  for (const char *run : {"b", "c"})
    table.add(run, {0.020 + 0.01 * (run[0] - 'b'), 0.021 + 0.01 * (run[0] - 'b'), 0.02, 0.02});
  const auto verdict = [&](const StudyRow &row) { return table.judged(row).verdict; };
  const std::vector<std::string> all{"a", "b", "c"};
  EXPECT_EQ(verdict(bracket_row(all)), RowVerdict::holds);
  for (const RunState state : {RunState::refused, RunState::rejected, RunState::failed, RunState::not_run})
  {
    table.outcomes[0].state = state; // one of four
    table.outcomes[1].state = RunState::measured;
    EXPECT_EQ(verdict(bracket_row(all)), RowVerdict::holds) << to_string(state);
    table.outcomes[1].state = state;
    EXPECT_EQ(verdict(bracket_row(all)), RowVerdict::not_measured) << to_string(state);
    EXPECT_EQ(verdict(row_of(all, Rule::rises)), RowVerdict::not_measured) << to_string(state);
    EXPECT_EQ(table.judged(bracket_row(all)).result("c").value().verdict(), Verdict::fails);
  }
  MadeUpStudy onset = above_onset(0.5);
  onset.add("lost", {NAN});
  onset.outcomes.back().state = RunState::failed;
  StudyRow row = onset_row(0.5, 0.2);
  EXPECT_EQ(onset.judged(row).verdict, RowVerdict::holds);
  row.runs.emplace_back("lost");
  EXPECT_EQ(onset.judged(row).verdict, RowVerdict::not_measured);
}

TEST(StudyTable, APatternThatComesBackHasNoCriticalValue)
{
  MadeUpStudy table;
  table.add("a", {NAN, NAN});
  table.add("b", {0.02, 0.02});
  table.add("c", {NAN, NAN});
  table.add("d", {0.02, 0.02});
  const RowOutcome row = table.judged(bracket_row({"a", "b", "c", "d"}));
  EXPECT_EQ(row.verdict, RowVerdict::does_not_hold);
  EXPECT_HAS(row.measured, "straight at 3 above oscillating at 2");
  EXPECT_EQ(table.judged(bracket_row({"a", "c", "d"})).verdict, RowVerdict::holds);
}

TEST(StudyTable, BracketLiesBetweenTheTwoPatterns)
{
  MadeUpStudy table;
  for (const char *run : {"a", "b"})
    table.add(run, {NAN, NAN});
  table.add("mixed", {NAN, 0.02});
  for (const char *run : {"d", "e"})
    table.add(run, {0.02, 0.02});
  const RowOutcome row = table.judged(bracket_row({"e", "d", "mixed", "b", "a"}));
  EXPECT_EQ(row.verdict, RowVerdict::holds);
  EXPECT_DOUBLE_EQ(row.number.value(), 3.);
  EXPECT_HAS(row.measured, "zeta between 2 and 4");
  EXPECT_EQ(table.judged(bracket_row({"a", "b", "mixed"})).verdict, RowVerdict::does_not_hold);
  EXPECT_EQ(table.judged(bracket_row({"mixed", "d", "e"})).verdict, RowVerdict::does_not_hold);

  MadeUpStudy reversed;
  reversed.add("a", {0.02});
  reversed.add("b", {NAN});
  EXPECT_EQ(reversed.judged(bracket_row({"a", "b"})).verdict, RowVerdict::does_not_hold);
}

TEST(StudyTable, RunsThatTheQuickStudyLeavesOut)
{
  MadeUpStudy table;
  table.add("a", {0.0100, 0.0101});
  table.add("b", {0.0200, 0.0201});
  const RowOutcome alone = table.judged(row_of({"big"}, Rule::above, 0.), {"big"});
  EXPECT_EQ(alone.verdict, RowVerdict::not_measured);
  EXPECT_EQ(alone.note, "big is omitted in the quick study");
  EXPECT_EQ(table.judged(row_of({"a", "b"}, Rule::rises), {"big"}).verdict, RowVerdict::holds);
  EXPECT_EQ(table.judged(row_of({"a", "b", "big"}, Rule::rises), {"big"}).verdict, RowVerdict::not_measured);
}

TEST(StudyTable, ResultsHaveTheVerdictsOfTheTable)
{
  MadeUpStudy table;
  table.add("a", {0.010, 0.011});
  table.add("b", {0.020, 0.021});
  table.add("s", {NAN, NAN});
  for (const StudyRow &row :
       {row_of({"a"}, Rule::is_near, 0.0105, 0.01), row_of({"a"}, Rule::is_near, 0.02, 0.1),
        row_of({"a"}, Rule::above, 1.), row_of({"a"}, Rule::below, 1.), row_of({"a", "b"}, Rule::rises),
        row_of({"a", "b"}, Rule::falls), row_of({"s"}, Rule::above), pattern_row({"a"}, "oscillating"),
        pattern_row({"a"}, "straight"), bracket_row({"a", "s"}), row_of({"a"}, Rule::reported), onset_row(0.5, 0.2)})
  {
    const RowOutcome outcome = table.judged(row);
    const Result result = outcome.result("c").value();
    const Verdict verdict = result.verdict();
    EXPECT_FALSE(result.error.value_or(0.) < 0.)
      << outcome.expected; // an error does not show the distance inside a bound
    EXPECT_EQ(verdict == Verdict::holds, outcome.verdict == RowVerdict::holds) << outcome.expected;
    EXPECT_EQ(verdict == Verdict::reported, outcome.verdict == RowVerdict::reported) << outcome.expected;
    EXPECT_EQ(verdict == Verdict::reported, result.tolerance.reason.empty()) << outcome.expected;
    EXPECT_EQ(outcome.is_test(), result.tolerance.reason.find("error: p of the test") == 0) << outcome.expected;
  }
}

TEST(StudyTable, OutputsHoldEveryRunAndRow)
{
  MadeUpStudy table;
  table.add("a", {0.010, NAN});
  StudyResults results;
  results.study.title = "T";
  results.study.runs = {{"a", "", {{"Sheet/height", "2 cm"}}, {}, {1, 2}}};
  results.study.claims = {{"claim", "paper", "", {row_of({"a"}, Rule::reported), pattern_row({"a"}, "oscillating")}}};
  results.plan = table.plan;
  results.outcomes = table.outcomes;
  results.outcomes[1].state = RunState::failed;
  results.outcomes[1].problem = "the state blew up";
  results.claims = judge(results.study, results.plan, results.outcomes);

  const std::string csv = study_csv(results);
  EXPECT_HAS(csv, "wavelength [m]");
  EXPECT_HAS(csv, "a,1,Sheet/height=2 cm,measured,oscillating,");
  EXPECT_HAS(csv, "a,2,Sheet/height=2 cm,failed,");
  const auto json = nlohmann::json::parse(study_json(results));
  EXPECT_EQ(json["seeds"][0]["values"]["wavelength"], 0.010);
  EXPECT_TRUE(json["seeds"][0]["values"]["amplitude"].is_null());
  EXPECT_EQ(json["claims"][0]["rows"].size(), 2u);
  EXPECT_EQ(json["verified"], false);
  EXPECT_EQ(json["claims"][0]["verdict"], "not measured");
  EXPECT_EQ(study_rows(results).verdict(), Verdict::fails);
  results.claims[0].rows[0].number = NAN;
  EXPECT_EQ(nlohmann::json::parse(study_json(results))["claims"][0]["rows"][0]["number"], "nan");
  std::ostringstream out;
  print_table(out, results);
  EXPECT_HAS(out.str(), "a, seed 2: failed: the state blew up");
}

} // namespace study_table_test
