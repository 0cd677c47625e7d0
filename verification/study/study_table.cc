#include "verification/study/study_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace verification
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
  return row.rule == Rule::is_near || row.rule == Rule::above || row.rule == Rule::below;
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
    return "at least " + value();
  case Rule::below:
    return "at most " + value();
  case Rule::rises:
    return "rises with " + row.against;
  case Rule::falls:
    return "falls with " + row.against;
  case Rule::bracket:
    return row.from + " at small " + row.against + ", " + row.to + " at large";
  default:
    return "";
  }
}

// Rules for each run by itself: all of them must fit, the worst one counts.
void judge_each(RowOutcome &outcome)
{
  const StudyRow &row = outcome.row;
  if (has_bound(row) && !outcome.bound)
    return;
  double worst = -std::numeric_limits<double>::infinity();
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
    if (misfit > worst)
    {
      worst = misfit;
      outcome.number = number;
    }
  }
  outcome.misfit = worst;
}

// Slope of ln(mean) over ln(abscissa), least squares; none unless all are positive and differ.
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

// By how many of its standard errors the later mean exceeds the earlier one, if `sign` is 1; infinite without errors.
double excess(const SeedStatistics &earlier, const SeedStatistics &later, double sign)
{
  const double difference = sign * (*later.mean - *earlier.mean);
  const double error = std::hypot(earlier.standard_error, later.standard_error);
  return difference == 0. ? 0. : error > 0. ? difference / error : std::copysign(INFINITY, difference);
}

constexpr double clear_excess = 2.; // standard errors, some 95 %

// What was measured along `against`, in the order of the row.
std::vector<const SeedStatistics *> measured_along(const RowOutcome &outcome)
{
  std::vector<const SeedStatistics *> points;
  for (const SeedStatistics &run : outcome.runs)
    if (run.is_measured() && run.abscissa)
      points.push_back(&run);
  return points;
}

// Along `against` the last mean must clearly exceed the first one, and none may clearly fall short of an earlier one;
// a quantity that saturates still rises.
void judge_trend(RowOutcome &outcome)
{
  const std::vector<const SeedStatistics *> points = measured_along(outcome);
  if (points.size() < 2)
    return;
  const double sign = outcome.row.rule == Rule::rises ? 1. : -1.;
  double against_it = excess(*points.front(), *points.back(), sign) > clear_excess ? 0. : 1.;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      against_it += excess(*points[i], *points[j], sign) < -clear_excess ? 1. : 0.;
  outcome.misfit = against_it;
  outcome.number = exponent(points);
  if (outcome.number)
    append(outcome.measured, "exponent " + quantity_text(*outcome.number, {}, "1"));
}

// Up to some value of `against` every run shows one pattern, from another value on every run shows the other. What
// lies between the two belongs to the bracket, whatever it shows.
void judge_bracket(RowOutcome &outcome)
{
  const std::vector<const SeedStatistics *> points = measured_along(outcome);
  if (points.size() < 2)
    return;
  const auto low = std::find_if_not(points.begin(), points.end(),
                                    [&](const SeedStatistics *run) { return run->shows(outcome.row.from); });
  const auto high = std::find_if_not(points.rbegin(), points.rend(),
                                     [&](const SeedStatistics *run) { return run->shows(outcome.row.to); });
  outcome.misfit = (low == points.begin() ? 1. : 0.) + (high == points.rbegin() ? 1. : 0.);
  const auto number = [](const SeedStatistics *run) { return quantity_text(*run->abscissa, {}, "1"); };
  if (low == points.begin())
    append(outcome.measured, "no " + outcome.row.from + " below " + number(points.front()));
  if (high == points.rbegin())
    append(outcome.measured, "no " + outcome.row.to + " above " + number(points.back()));
  if (*outcome.misfit > 0.)
    return;
  const SeedStatistics *last_from = *std::prev(low);
  const SeedStatistics *first_to = *std::prev(high);
  outcome.number = (*last_from->abscissa + *first_to->abscissa) / 2.;
  append(outcome.measured, outcome.row.against + " between " + number(last_from) + " and " + number(first_to));
}

// Seeds and runs without the quantity, each with the reason.
std::string missing_text(const RowOutcome &outcome, const std::vector<std::string> &left_out)
{
  std::string note;
  for (const std::string &run : left_out)
    append(note, run + " is not part of the quick study");
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
  if (!row.bound_run.empty())
  {
    const SeedStatistics other = statistics(row.bound_run, row.quantity, outcomes);
    if (other.is_measured())
      outcome.bound = other.mean;
    else
      append(outcome.note, row.bound_run + ", to compare with, was not measured");
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

  const bool along = row.rule == Rule::rises || row.rule == Rule::falls || row.rule == Rule::bracket;
  if (row.rule == Rule::bracket)
    judge_bracket(outcome);
  else if (along)
    judge_trend(outcome);
  else if (row.rule != Rule::reported && without.empty())
    judge_each(outcome);
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
  default:
    return "not measured";
  }
}

std::optional<Result> RowOutcome::result(const std::string &claim) const
{
  if (!number && !misfit)
    return {};
  std::string names;
  for (const std::string &run : row.runs)
    append(names, run, ", ");
  Result result{claim, names + ": " + row.quantity, row.unit(), number, {}, {}, {}, {}};
  if (bound)
    result.theory = bound;
  if (row.rule == Rule::is)
    result.theory = 1.;
  if (row.rule == Rule::rises || row.rule == Rule::falls || row.rule == Rule::bracket)
  {
    result.quantity += ", " + expected;
    result.unit = "1";
  }
  if (misfit)
  {
    result.error = std::max(*misfit, 0.); // beyond the bound; not how far inside
    result.tolerance = allowed();
  }
  return result;
}

RowVerdict ClaimResult::verdict() const
{
  for (const RowVerdict first : {RowVerdict::does_not_hold, RowVerdict::holds, RowVerdict::not_measured})
    if (std::any_of(rows.begin(), rows.end(), [first](const RowOutcome &row) { return row.verdict == first; }))
      return first;
  return RowVerdict::reported;
}

} // namespace verification
