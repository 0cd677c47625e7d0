#include "verification/study/refinement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "verification/study/sweep.h"

namespace latcon::study
{
namespace
{

// Position in the grid, in units of the spacing of the finest level, one index per swept entry.
using Index = std::vector<long>;

// Axis of the grid: sorted values of a swept entry.
struct Axis
{
  std::string entry;
  std::vector<double> values; // SI

  double value(long index, long per_interval) const
  {
    const auto left = static_cast<std::size_t>(index / per_interval);
    const double share = static_cast<double>(index % per_interval) / static_cast<double>(per_interval);
    return share == 0. ? values[left] : values[left] + share * (values[left + 1] - values[left]);
  }

  // Index of a value: that of the finest level closest to it, since values are written with twelve digits.
  long index(double value, long per_interval) const
  {
    if (values.size() < 2)
      return 0;
    const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, value);
    const double share = (value - *(above - 1)) / (*above - *(above - 1));
    return (above - 1 - values.begin()) * per_interval + std::lround(share * static_cast<double>(per_interval));
  }
};

double value_of(const PlannedRun &run, const std::string &entry)
{
  const std::optional<double> value = run.value(entry);
  if (!value)
    throw std::logic_error("refinement: " + entry + " is not a number");
  return *value;
}

// Patterns of the seeds of each run; empty for runs of which no seed was measured.
std::map<std::string, std::set<std::string>> patterns_of(const std::vector<RunOutcome> &outcomes)
{
  std::map<std::string, std::set<std::string>> patterns;
  for (const RunOutcome &outcome : outcomes)
    if (outcome.state == RunState::measured)
      patterns[outcome.run].insert(outcome.pattern);
  return patterns;
}

bool differ(const std::set<std::string> &a, const std::set<std::string> &b)
{
  return !a.empty() && !b.empty() && !(a == b && a.size() == 1);
}

} // namespace

std::vector<StudyRun> refined_runs(const Study &study, const std::vector<PlannedRun> &plan,
                                   const std::vector<RunOutcome> &outcomes, const std::size_t level)
{
  if (study.swept.empty() || level < 1)
    throw std::logic_error("refinement: needs a sweep and a level from 1");
  std::map<std::string, const StudyRun *> runs;
  for (const StudyRun &run : study.runs)
    if (run.is_swept)
      runs[run.name] = &run;

  std::vector<Axis> axes;
  for (const std::string &entry : study.swept)
  {
    std::set<double> values;
    for (const PlannedRun &run : plan)
      if (const auto found = runs.find(run.run); found != runs.end() && found->second->level == 0)
        values.insert(value_of(run, entry));
    axes.push_back({entry, {values.begin(), values.end()}});
  }
  const long per_interval = 1L << level; // points of this level are at odd indices
  std::map<Index, std::string> points;
  for (const PlannedRun &run : plan)
    if (runs.count(run.run) > 0)
    {
      Index at;
      for (const Axis &axis : axes)
        at.push_back(axis.index(value_of(run, axis.entry), per_interval));
      points[at] = run.run;
    }

  std::map<std::string, std::set<std::string>> patterns = patterns_of(outcomes);
  std::map<Index, StudyRun> found;
  for (const auto &[at, name] : points)
    for (std::size_t i = 0; i < axes.size(); ++i)
    {
      Index next = at, middle = at;
      next[i] += 2;
      middle[i] += 1;
      const auto neighbour = points.find(next);
      if (neighbour == points.end() || points.count(middle) > 0 || !differ(patterns[name], patterns[neighbour->second]))
        continue;
      std::vector<Sweep> values;
      for (std::size_t axis = 0; axis < axes.size(); ++axis)
        values.push_back({axes[axis].entry, {plain_number(axes[axis].value(middle[axis], per_interval))}});
      const SweptCase swept = combination(values, std::vector<std::size_t>(values.size(), 0));
      StudyRun run = *runs.at(name);
      run.name = swept.name;
      run.level = level;
      override_settings(run.own, swept.set);
      override_settings(run.all, swept.set);
      found.emplace(middle, std::move(run));
    }
  std::vector<StudyRun> refined;
  for (auto &[at, run] : found)
  {
    const auto has_name = [&name = run.name](const StudyRun &other) { return other.name == name; };
    if (run.name.size() > max_name_length || std::any_of(study.runs.begin(), study.runs.end(), has_name))
      run.name = "level-" + std::to_string(level) + "-" + std::to_string(refined.size() + 1);
    refined.push_back(std::move(run));
  }
  return refined;
}

} // namespace latcon::study
