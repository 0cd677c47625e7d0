#include "verification/study/study_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "support/errors.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/resources/resources.h"

namespace latcon::study
{
namespace
{

std::map<std::string, double> numbers_in(const std::string &case_text)
{
  std::map<std::string, double> numbers;
  for (const auto &item : input::read_prm(case_text, "case"))
    if (const auto *assignment = std::get_if<input::Assignment>(&item))
    {
      char *end = nullptr;
      const double value = std::strtod(assignment->value.c_str(), &end);
      if (!assignment->value.empty() && *end == '\0' && std::isfinite(value))
        numbers[assignment->section + "/" + assignment->name] = value;
    }
  return numbers;
}

PlannedRun plan_run(const Study &study, const input::InputFile &base, const StudyRun &run, const std::uint64_t seed,
                    const Settings &settings)
{
  PlannedRun planned;
  planned.run = run.name;
  planned.seed = seed;
  Settings all = run.all;
  override_settings(all, settings);
  override_settings(
    all, {{seed_entry, std::to_string(seed)}, {"Output/frame interval", "0"}, {"Output/motion frames", "0"}});
  std::vector<std::string> changes;
  for (const auto &[key, value] : all)
    changes.push_back(key + "=" + value);

  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  if (base.problem.empty())
    parameters.read_text(base.text, study.base);
  else
    parameters.read_file(study.base); // throws the same problems
  parameters.read_overrides(changes);
  input.check(parameters);
  bridge::require_fracture_case(input, parameters);
  parameters.finish();

  const lattice::TriangularLattice sheet = input.lattice();
  planned.case_text = parameters.resolved_text();
  planned.spacing = input.spacing;
  planned.zeta = zeta(input);
  planned.entries = numbers_in(planned.case_text);
  planned.sites = sheet.n_sites();
  const resources::MemoryNeed memory = resources::lattice_memory(input, resources::RunKind::fracture, true);
  planned.memory = memory.shared + memory.first_rank;
  const lattice::TimeStepping stepping = input.fracture_time_stepping();
  planned.steps = resources::expected_steps(input, stepping) * stepping.evaluations();
  return planned;
}

// Adds a problem for each row whose `against` is not a number in any of its runs.
void check_abscissas(const Study &study, const std::vector<PlannedRun> &runs, std::vector<std::string> &problems)
{
  for (const StudyClaim &claim : study.claims)
    for (const StudyRow &row : claim.rows)
    {
      if (row.against.empty())
        continue;
      const auto has_number = [&row](const PlannedRun &run)
      {
        return std::find(row.runs.begin(), row.runs.end(), run.run) != row.runs.end() &&
               run.value(row.against).has_value();
      };
      const auto is_left_out = [&study](const std::string &run)
      { return std::find(study.left_out.begin(), study.left_out.end(), run) != study.left_out.end(); };
      if (std::none_of(runs.begin(), runs.end(), has_number) &&
          !std::all_of(row.runs.begin(), row.runs.end(), is_left_out))
        problems.push_back(row.place + "/against: " + row.against + " is not a number in any of these runs");
    }
}

// Splits "Section/Name=value"; the case checks names and values when it reads them.
Settings parse_settings(const std::vector<std::string> &texts)
{
  Settings settings;
  for (const std::string &text : texts)
  {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw support::InputError("--set: not understood: '" + input::printable(text) +
                                "'; allowed: --set Section/Name=value");
    override_settings(settings, {{input::trimmed(text.substr(0, equals)), input::trimmed(text.substr(equals + 1))}});
  }
  for (const auto &[key, value] : settings)
    if (key == seed_entry)
      throw support::InputError("--set: " + key + " is set by the seeds of the study");
  return settings;
}

} // namespace

std::optional<double> zeta(const input::Case &input)
{
  const input::ShellCase &bond = input.nearest;
  if (bond.law != input::ShellCase::Law::mooney_rivlin || !(bond.a > 0.))
    return {};
  return bond.viscosity / bond.a * std::sqrt(bond.a / input.density) / input.spacing;
}

std::optional<double> PlannedRun::value(const std::string &against) const
{
  if (against == "zeta")
    return zeta;
  const auto found = entries.find(against);
  return found == entries.end() ? std::nullopt : std::optional<double>(found->second);
}

std::vector<PlannedRun> plan_runs(const Study &study, const input::InputFile &base,
                                  const std::vector<std::string> &settings)
{
  const Settings overrides = parse_settings(settings);
  std::vector<PlannedRun> runs;
  std::vector<std::string> problems;
  for (const StudyRun &run : study.runs)
    try
    {
      for (const std::uint64_t seed : run.seeds)
        runs.push_back(plan_run(study, base, run, seed, overrides));
    }
    catch (const support::InputError &error)
    {
      // A problem of the base case occurs in every run: report it once.
      for (const std::string &problem : error.problems())
      {
        const std::string text = ": " + problem;
        const auto ends_alike = [&text](const std::string &known)
        { return known.size() >= text.size() && known.compare(known.size() - text.size(), text.size(), text) == 0; };
        if (std::none_of(problems.begin(), problems.end(), ends_alike))
          problems.push_back(study.file + ": runs/" + run.name + text);
      }
    }
  if (problems.empty())
    check_abscissas(study, runs, problems);
  if (!problems.empty())
    throw support::InputError(problems);
  return runs;
}

std::vector<std::size_t> longest_first(const std::vector<PlannedRun> &runs)
{
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&runs](std::size_t a, std::size_t b) { return runs[a].cost() > runs[b].cost(); });
  return order;
}

} // namespace latcon::study
