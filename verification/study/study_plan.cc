#include "verification/study/study_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "support/errors.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/elements/elements.h"
#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/input/sha256.h"
#include "verification/resources/resources.h"

namespace latcon::study
{
namespace
{

// Value of an entry as a number; NaN if it is not a finite one.
double number_or_nan(const std::string &text)
{
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> assignments(const Settings &settings)
{
  std::vector<std::string> texts;
  for (const auto &[key, value] : settings)
    texts.push_back(key + "=" + value);
  return texts;
}

// Reads a base case with changes `Section/Name=value`, and checks it. The caller calls Parameters::finish().
void read_case(const input::InputFile &base, const std::string &base_name, const std::vector<std::string> &changes,
               input::Case &input, input::Parameters &parameters)
{
  input.declare(parameters);
  if (base.problem.empty())
    parameters.read_text(base.text, base_name);
  else
    parameters.read_file(base_name); // throws the same problems
  parameters.read_overrides(changes);
  input.check(parameters);
}

void resolve(const PlannedCase &planned, const std::uint64_t seed, const Verification verification, input::Case &input,
             input::Parameters &parameters)
{
  std::vector<std::string> changes = planned.changes;
  changes.push_back(std::string(seed_entry) + "=" + std::to_string(seed));
  read_case(*planned.base, planned.base_name, changes, input, parameters);
  bridge::require_fracture_case(input, parameters);
  if (verification == Verification::every_run)
    claims::check_user_laws(input, parameters);
  parameters.finish();
}

// Sets the size and the cost of a run. Adds problems of a case that the finite elements do not support.
void estimate(const input::Case &input, input::Parameters &parameters, PlannedRun &run)
{
  resources::MemoryNeed memory;
  if (run.planned_case->on_continuum)
  {
    const elements::CrackCost cost = elements::elements().crack_cost(input, parameters);
    run.size = cost.cells;
    run.evaluations = cost.evaluations;
    run.seconds = resources::damage_seconds(run.size, run.evaluations);
    memory = resources::damage_memory(run.size);
  }
  else
  {
    const lattice::TimeStepping stepping = input.fracture_time_stepping();
    run.size = static_cast<double>(input.lattice().n_sites());
    run.evaluations = resources::expected_steps(input, stepping) * stepping.evaluations();
    run.seconds = resources::core_seconds(run.size * run.evaluations);
    memory = resources::lattice_memory(input, resources::RunKind::fracture, true);
  }
  run.memory = memory.shared + memory.first_rank;
}

// Adds the seeds of a run, whose case is resolved once.
// @param changed entries that a run of the study changes
// @param shared base case, its name, and `keys` once the first case has been resolved
void plan_seeds(const StudyRun &run, const Settings &settings, const std::set<std::string> &changed,
                const Verification verification, PlannedCase &shared, std::vector<PlannedRun> &runs)
{
  Settings all = run.all;
  override_settings(all, settings);
  override_settings(all, {{"Output/frame interval", "0"}, {"Output/motion frames", "0"}});
  const auto planned = std::make_shared<PlannedCase>(shared);
  planned->changes = assignments(all);
  planned->on_continuum = run.on_continuum;

  input::Case input;
  input::Parameters parameters;
  resolve(*planned, run.seeds.front(), verification, input, parameters);
  const std::vector<std::pair<std::string, std::string>> values = parameters.values();
  if (shared.keys == nullptr)
  {
    const auto keys = std::make_shared<std::vector<std::string>>();
    for (const auto &[key, value] : values)
      keys->push_back(key);
    shared.keys = planned->keys = keys;
  }
  for (const auto &[key, value] : values)
  {
    planned->numbers.push_back(number_or_nan(value));
    if (std::isnan(planned->numbers.back()) && changed.count(key) > 0)
      planned->texts[key] = value;
  }

  PlannedRun of_seed;
  of_seed.run = run.name;
  of_seed.planned_case = planned;
  of_seed.spacing = input.spacing;
  of_seed.zeta = zeta(input);
  estimate(input, parameters, of_seed);
  for (const std::uint64_t seed : run.seeds)
  {
    of_seed.seed = input.noise_seed = seed; // any number is allowed
    of_seed.case_sha256 = input::sha256(parameters.lines());
    runs.push_back(of_seed);
  }
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
  if (against == seed_entry)
    return static_cast<double>(seed);
  if (planned_case == nullptr)
    return {};
  const std::vector<std::string> &keys = *planned_case->keys;
  const auto found = std::lower_bound(keys.begin(), keys.end(), against);
  if (found == keys.end() || *found != against)
    return {};
  const double number = planned_case->numbers[static_cast<std::size_t>(found - keys.begin())];
  return std::isnan(number) ? std::nullopt : std::optional<double>(number);
}

std::string PlannedRun::text(const std::string &key) const
{
  if (planned_case == nullptr)
    return "";
  const auto found = planned_case->texts.find(key);
  return found == planned_case->texts.end() ? "" : found->second;
}

std::string PlannedRun::case_text() const
{
  input::Case input;
  input::Parameters parameters;
  resolve(*planned_case, seed, Verification::none, input, parameters); // checked when it was planned
  return parameters.resolved_text();
}

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

std::vector<PlannedRun> plan_runs(const Study &study, const input::InputFile &base,
                                  const std::vector<std::string> &settings, const Verification verification)
{
  const Settings overrides = parse_settings(settings);
  for (const auto &[key, value] : overrides)
    if (std::find(study.swept.begin(), study.swept.end(), key) != study.swept.end())
      throw support::InputError("--set: " + key + " is also an entry of the sweep of " + study.file);
  std::set<std::string> changed;
  for (const StudyRun &run : study.runs)
    for (const auto &[key, value] : run.own)
      changed.insert(key);
  PlannedCase shared;
  shared.base = std::make_shared<const input::InputFile>(base);
  shared.base_name = study.base;
  std::vector<PlannedRun> runs;
  std::vector<std::string> problems;
  for (const StudyRun &run : study.runs)
    try
    {
      plan_seeds(run, overrides, changed, verification, shared, runs);
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
  if (verification == Verification::base_case)
    (void)base_case(study, base, settings);
  return runs;
}

input::Case base_case(const Study &study, const input::InputFile &base, const std::vector<std::string> &settings)
{
  Settings all = study.settings;
  override_settings(all, parse_settings(settings));
  input::Case input;
  input::Parameters parameters;
  read_case(base, study.base, assignments(all), input, parameters);
  claims::check_user_laws(input, parameters);
  parameters.finish();
  return input;
}

std::vector<std::size_t> longest_first(const std::vector<PlannedRun> &runs)
{
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&runs](std::size_t a, std::size_t b) { return runs[a].seconds > runs[b].seconds; });
  return order;
}

} // namespace latcon::study
