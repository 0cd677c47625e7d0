#include "verification/study/study_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/largest_error.h"

namespace latcon::study
{
namespace
{

bool is_among(const std::string &name, const std::vector<std::string> &names)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

void append(std::string &text, const std::string &more, const std::string &separator = "; ")
{
  if (!more.empty())
    text += (text.empty() ? "" : separator) + more;
}

bool has_bound(const StudyRow &row)
{
  return row.rule == Rule::is_near || row.rule == Rule::above || row.rule == Rule::below ||
         row.rule == Rule::onset_exponent;
}

std::string expectation(const StudyRow &row, const std::optional<double> &bound)
{
  const auto value = [&]
  {
    const std::string number = bound ? quantity_text(*bound, {}, row.unit()) : "";
    return row.bound_run.empty() ? number : "that of " + row.bound_run + (bound ? " (" + number + ")" : "");
  };
  switch (row.rule)
  {
  case Rule::is:
    return row.pattern;
  case Rule::is_near:
    return "near " + value() + " within " + quantity_text(100. * row.tolerance, {}, "1") + " %";
  case Rule::above:
    return (row.bound_run.empty() ? "at least " : "above ") + value();
  case Rule::below:
    return (row.bound_run.empty() ? "at most " : "below ") + value();
  case Rule::rises:
    return "rises with " + row.against;
  case Rule::falls:
    return "falls with " + row.against;
  case Rule::onset_exponent:
    return "rises above an onset with an exponent of " + quantity_text(row.bound, {}, "1") + " ± " +
           quantity_text(row.tolerance, {}, "1");
  case Rule::bracket:
    return row.from + " at small " + row.against + ", " + row.to + " at large";
  default:
    return "";
  }
}

// What the column `error` of results.csv is, for a rule.
std::string meaning(const RowOutcome &outcome)
{
  const Rule rule = outcome.row.rule;
  return outcome.is_test()              ? "error: p of the test, 1 if means contradict the rule"
         : rule == Rule::is             ? "error: share of seeds with another pattern"
         : rule == Rule::is_near        ? "error: relative difference"
         : rule == Rule::onset_exponent ? "error: distance of the interval from the expected exponent"
         : rule == Rule::bracket        ? "error: number of contradictions to one critical value"
                                        : "error: excess beyond the bound, in the unit of the quantity";
}

std::string p_text(double p)
{
  return p < 1e-4 ? "p < 0.0001" : "p = " + quantity_text(std::round(1e4 * p) / 1e4, {}, "1");
}

constexpr const char *no_scatter =
  "the scatter of the seeds is unknown: at least two seeds with different values are needed";

// Compares each run with another run: all must be significantly on the side that the rule requires.
void judge_beside(RowOutcome &outcome, const SeedStatistics &other)
{
  support::LargestError worst;
  for (const SeedStatistics &run : outcome.runs)
  {
    if (!run.is_measured())
      return;
    const bool above = outcome.row.rule == Rule::above;
    const std::optional<double> p = welch_p_value((above ? other : run).sample(), (above ? run : other).sample());
    if (!p)
    {
      append(outcome.note, run.run + " compared with " + other.run + ": " + no_scatter);
      return;
    }
    worst.add(*p, *run.mean);
  }
  outcome.number = worst.value();
  outcome.misfit = worst.error();
  append(outcome.measured, p_text(worst.error()));
}

// Rules for individual runs: all must satisfy the rule; the largest misfit counts.
void judge_each(RowOutcome &outcome)
{
  const StudyRow &row = outcome.row;
  if (has_bound(row) && !outcome.bound)
    return;
  support::LargestError worst;
  for (const SeedStatistics &run : outcome.runs)
  {
    if (!run.is_measured())
      return;
    double misfit = 0.;
    double number = 0.;
    if (row.rule == Rule::is)
    {
      const auto found = run.patterns.find(row.pattern);
      const double with = found == run.patterns.end() ? 0. : static_cast<double>(found->second);
      number = with / static_cast<double>(run.n);
      misfit = 1. - number;
    }
    else
    {
      number = *run.mean;
      misfit = row.rule == Rule::is_near ? std::abs(number / *outcome.bound - 1.)
               : row.rule == Rule::above ? *outcome.bound - number
                                         : number - *outcome.bound;
    }
    worst.add(misfit, number);
  }
  outcome.number = worst.value();
  outcome.misfit = worst.error();
}

// Returns the least-squares slope of ln(mean) over ln(abscissa); none unless all are positive and the abscissas differ.
std::optional<double> exponent(const std::vector<const SeedStatistics *> &points)
{
  double n = 0., sx = 0., sy = 0., sxx = 0., sxy = 0.;
  for (const SeedStatistics *point : points)
  {
    if (!(*point->abscissa > 0.) || !(*point->mean > 0.))
      return {};
    const double x = std::log(*point->abscissa);
    const double y = std::log(*point->mean);
    n += 1., sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  return spread > 1e-12 * n * sxx ? std::optional<double>((n * sxy - sx * sy) / spread) : std::nullopt;
}

// Returns the measured runs with a value of `against`, in the order of the row.
std::vector<const SeedStatistics *> measurements_along(const RowOutcome &outcome)
{
  std::vector<const SeedStatistics *> points;
  for (const SeedStatistics &run : outcome.runs)
    if (run.is_measured() && run.abscissa)
      points.push_back(&run);
  return points;
}

// Describes the pairs of means of which the later one is significantly smaller, with Holm's adjustment over all pairs.
std::string falling_pairs(const std::vector<const SeedStatistics *> &points, const std::vector<SampleMean> &samples)
{
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<double> p_values;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j)
    {
      pairs.emplace_back(i, j);
      p_values.push_back(welch_p_value(samples[j], samples[i]).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  const std::vector<double> adjusted = adjust_by_holm(p_values);
  std::string text;
  for (std::size_t pair = 0; pair < pairs.size(); ++pair)
    if (adjusted[pair] <= significance)
      append(text,
             "from " + quantity_text(*points[pairs[pair].first]->abscissa, {}, "1") + " to " +
               quantity_text(*points[pairs[pair].second]->abscissa, {}, "1"),
             ", ");
  return text;
}

// Along `against` the means must rise and must not fall anywhere; a quantity that saturates still rises.
void judge_trend(RowOutcome &outcome)
{
  const std::vector<const SeedStatistics *> points = measurements_along(outcome);
  if (points.size() < 2)
    return;
  const bool rises = outcome.row.rule == Rule::rises;
  std::vector<SampleMean> samples;
  for (const SeedStatistics *point : points)
  {
    samples.push_back(point->sample());
    samples.back().mean *= rises ? 1. : -1.;
  }
  outcome.number = exponent(points);
  const std::optional<TrendTest> test = isotonic_test(samples);
  if (!test)
  {
    append(outcome.note, no_scatter);
    return;
  }
  const std::string with_it = rises ? "rise" : "fall", against_it = rises ? "fall" : "rise";
  // Means that violate the rule anywhere do not hold.
  const bool is_broken = !(test->p_fall > significance);
  outcome.misfit = is_broken ? 1. : test->p_rise;
  append(outcome.measured, with_it + ": " + p_text(test->p_rise));
  append(outcome.measured, "a " + against_it + " in between: " + p_text(test->p_fall));
  if (const std::string pairs = is_broken ? falling_pairs(points, samples) : ""; !pairs.empty())
    append(outcome.measured, "clearly " + pairs);
  if (outcome.number)
    append(outcome.measured, "exponent " + quantity_text(*outcome.number, {}, "1"));
}

// Up to one value of `against` every run shows one pattern, and from another value on every run shows the other. Runs
// between the two values belong to the bracket, with mixed or other patterns, unless the first pattern comes back after
// the second: then there is no one critical value.
void judge_bracket(RowOutcome &outcome)
{
  const std::vector<const SeedStatistics *> points = measurements_along(outcome);
  if (points.size() < 2)
    return;
  const auto low = std::find_if_not(points.begin(), points.end(),
                                    [&](const SeedStatistics *run) { return run->shows(outcome.row.from); });
  const auto high = std::find_if_not(points.rbegin(), points.rend(),
                                     [&](const SeedStatistics *run) { return run->shows(outcome.row.to); });
  const auto returned = std::find_if(points.rbegin(), points.rend(),
                                     [&](const SeedStatistics *run) { return run->shows(outcome.row.from); });
  const auto reached = std::find_if(points.begin(), returned.base(),
                                    [&](const SeedStatistics *run) { return run->shows(outcome.row.to); });
  outcome.misfit =
    (low == points.begin() ? 1. : 0.) + (high == points.rbegin() ? 1. : 0.) + (reached != returned.base() ? 1. : 0.);
  const auto number = [](const SeedStatistics *run) { return quantity_text(*run->abscissa, {}, "1"); };
  if (low == points.begin())
    append(outcome.measured, "no " + outcome.row.from + " below " + number(points.front()));
  if (high == points.rbegin())
    append(outcome.measured, "no " + outcome.row.to + " above " + number(points.back()));
  if (reached != returned.base())
    append(outcome.measured,
           outcome.row.from + " at " + number(*returned) + " above " + outcome.row.to + " at " + number(*reached));
  if (*outcome.misfit > 0.)
    return;
  const SeedStatistics *last_from = *std::prev(low);
  const SeedStatistics *first_to = *std::prev(high);
  outcome.number = (*last_from->abscissa + *first_to->abscissa) / 2.;
  append(outcome.measured, outcome.row.against + " between " + number(last_from) + " and " + number(first_to));
}

// The confidence interval of the exponent must be within the tolerance of the bound; if it reaches beyond, nothing is
// said about the exponent.
void judge_onset(RowOutcome &outcome)
{
  std::vector<OnsetPoint> points;
  for (const SeedStatistics *run : measurements_along(outcome))
    points.push_back({*run->abscissa, run->sample()});
  outcome.onset = fit_onset(points);
  if (!outcome.onset)
  {
    append(outcome.note, "no curve: five runs with different abscissas and positive means are needed, and " +
                           std::string(no_scatter));
    return;
  }
  const auto text = [](const Interval &interval)
  {
    const auto number = [](double value) { return quantity_text(value, {}, "1"); };
    return number(interval.value) + " (" + number(interval.low) + " to " + number(interval.high) + ")";
  };
  const OnsetFit &fit = *outcome.onset;
  outcome.number = fit.exponent.value;
  append(outcome.measured, "exponent " + text(fit.exponent) + ", onset at " + text(fit.onset) + ", 95 % confidence");
  append(outcome.measured, "means on the curve: " + p_text(fit.p_fit));
  // Distances of the bound from the far and from the near end of the interval.
  const double low = outcome.row.bound - fit.exponent.low, high = fit.exponent.high - outcome.row.bound;
  const double far = support::largest_of({low, high}), near = support::largest_of({-low, -high});
  if (fit.is_bounded() && far <= outcome.row.tolerance)
    outcome.misfit = far;
  else if (near > outcome.row.tolerance)
    outcome.misfit = near;
  else
    append(outcome.note, "the interval of the exponent is too wide to tell");
}

// Lists seeds and runs without the quantity, with the reasons.
std::string missing_text(const RowOutcome &outcome, const std::vector<std::string> &left_out)
{
  std::string note;
  for (const std::string &run : left_out)
    append(note, run + " is omitted in the quick study");
  for (const SeedStatistics &run : outcome.runs)
  {
    std::string seeds;
    for (const std::string &seed : run.missing)
      append(seeds, seed, ", ");
    if (!seeds.empty())
      append(note, run.run + ": not measured in " + std::to_string(run.missing.size()) + " of " +
                     std::to_string(run.n_seeds) + " (" + seeds + ")");
  }
  return note;
}

} // namespace

RowOutcome judge(const StudyRow &row, const std::vector<PlannedRun> &plan, const std::vector<RunOutcome> &outcomes,
                 const std::vector<std::string> &left_out)
{
  RowOutcome outcome;
  outcome.row = row;
  const SeedStatistics other = statistics(row.bound_run, row.quantity, outcomes);
  if (!row.bound_run.empty())
  {
    if (other.is_measured())
      outcome.bound = other.mean;
    else
      append(outcome.note, row.bound_run + ", the run to compare with, was not measured");
  }
  else if (has_bound(row))
    outcome.bound = row.bound;
  outcome.expected = expectation(row, outcome.bound);
  std::vector<std::string> without;
  for (const std::string &name : row.runs)
  {
    if (is_among(name, left_out))
    {
      without.push_back(name);
      continue;
    }
    outcome.runs.push_back(statistics(name, row.quantity, outcomes));
    for (const PlannedRun &planned : plan)
      if (planned.run == name && !row.against.empty())
        outcome.runs.back().abscissa = planned.value(row.against);
  }
  std::stable_sort(outcome.runs.begin(), outcome.runs.end(),
                   [](const SeedStatistics &a, const SeedStatistics &b) { return a.abscissa < b.abscissa; });

  // Cracks without the quantity are an answer along `against`; runs that were omitted or lost are none.
  const bool is_whole = without.empty() && std::none_of(outcome.runs.begin(), outcome.runs.end(),
                                                        [](const SeedStatistics &run) { return run.is_lost(); });
  if (is_whole && row.rule == Rule::bracket)
    judge_bracket(outcome);
  else if (is_whole && row.rule == Rule::onset_exponent)
    judge_onset(outcome);
  else if (is_whole && is_along(row.rule))
    judge_trend(outcome);
  else if (is_whole && row.rule != Rule::reported && !outcome.is_test())
    judge_each(outcome);
  else if (is_whole && row.rule != Rule::reported && outcome.bound)
    judge_beside(outcome, other);
  else if (outcome.runs.size() == 1)
    outcome.number = outcome.runs.front().mean;

  if (row.rule == Rule::reported)
    outcome.verdict = RowVerdict::reported;
  else if (outcome.misfit)
    outcome.verdict = *outcome.misfit <= outcome.allowed() ? RowVerdict::holds : RowVerdict::does_not_hold;
  for (const SeedStatistics &run : outcome.runs)
  {
    const std::string at = run.abscissa ? quantity_text(*run.abscissa, {}, "1") : run.run;
    append(outcome.measured, (outcome.runs.size() > 1 ? at + ": " : "") + run.text(row.unit()));
  }
  append(outcome.note, missing_text(outcome, without));
  return outcome;
}

std::vector<ClaimResult> judge(const Study &study, const std::vector<PlannedRun> &plan,
                               const std::vector<RunOutcome> &outcomes)
{
  std::vector<ClaimResult> claims;
  for (const StudyClaim &claim : study.claims)
  {
    claims.push_back({claim, {}});
    for (const StudyRow &row : claim.rows)
      claims.back().rows.push_back(judge(row, plan, outcomes, study.left_out));
  }
  return claims;
}

std::string to_string(const RowVerdict verdict)
{
  switch (verdict)
  {
  case RowVerdict::holds:
    return "holds";
  case RowVerdict::does_not_hold:
    return "does not hold";
  case RowVerdict::reported:
    return "reported";
  case RowVerdict::incomplete:
    return "incomplete";
  default:
    return "not measured";
  }
}

bool RowOutcome::is_test() const
{
  const bool is_bound_by_run = !row.bound_run.empty() && row.rule != Rule::is_near;
  return row.rule == Rule::rises || row.rule == Rule::falls || is_bound_by_run;
}

double RowOutcome::allowed() const
{
  return row.rule == Rule::is_near || row.rule == Rule::onset_exponent ? row.tolerance : is_test() ? significance : 0.;
}

std::optional<output::Result> RowOutcome::result(const std::string &claim) const
{
  if (!number && verdict == RowVerdict::reported)
    return {};
  std::string names;
  for (const std::string &run : row.runs)
    append(names, run, ", ");
  output::Result result{claim, names + ": " + row.quantity, row.unit(), number, {}, {}, {}, {}};
  if (bound)
    result.theory = bound;
  if (row.rule == Rule::is)
    result.theory = 1.;
  if (is_along(row.rule))
  {
    result.quantity += ", " + expected;
    result.unit = "1";
  }
  if (verdict != RowVerdict::reported)
  {
    // Excess beyond the bound; 0 inside.
    result.error = misfit ? support::one_sided(*misfit) : std::numeric_limits<double>::quiet_NaN();
    result.tolerance = {allowed(), meaning(*this)};
  }
  return result;
}

RowVerdict ClaimResult::verdict() const
{
  const auto any = [this](RowVerdict verdict) {
    return std::any_of(rows.begin(), rows.end(), [verdict](const RowOutcome &row) { return row.verdict == verdict; });
  };
  if (any(RowVerdict::does_not_hold))
    return RowVerdict::does_not_hold;
  if (any(RowVerdict::not_measured))
    return any(RowVerdict::holds) ? RowVerdict::incomplete : RowVerdict::not_measured;
  return any(RowVerdict::holds) ? RowVerdict::holds : RowVerdict::reported;
}

} // namespace latcon::study
