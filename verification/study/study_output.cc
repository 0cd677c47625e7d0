#include "verification/study/study_output.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <utility>

#include <nlohmann/json.hpp>

#include "support/full_precision.h"
#include "support/text_wrap.h"
#include "verification/output/csv.h"
#include "verification/output/run_info.h"
#include "verification/resources/resources.h"

namespace latcon::study
{
namespace
{

using Json = nlohmann::ordered_json;

// Null means that there is no value, and JSON has no number that is not finite.
Json json_of(const std::optional<double> &value)
{
  if (!value)
    return nullptr;
  return std::isfinite(*value) ? Json(*value) : Json(support::full_precision(*value));
}

Json json_of(const Settings &settings)
{
  Json object = Json::object();
  for (const auto &[key, value] : settings)
    object[key] = value;
  return object;
}

Json json_of(const PlannedRun &planned, const RunOutcome &outcome)
{
  Json run;
  run["run"] = outcome.run;
  run["seed"] = outcome.seed;
  run["folder"] = "runs/" + planned.folder();
  run["state"] = to_string(outcome.state);
  run["exit_code"] = outcome.exit_code;
  run["problem"] = outcome.problem;
  run["pattern"] = outcome.pattern.empty() ? Json(nullptr) : Json(outcome.pattern);
  run["reason"] = outcome.reason;
  run["side"] = planned.side();
  run[planned.side() == "lattice" ? "sites" : "cells"] = static_cast<std::uint64_t>(planned.size);
  run["values"] = Json::object();
  for (const StudyQuantity &quantity : quantities())
  {
    const auto found = outcome.values.find(quantity.name);
    run["values"][quantity.name] = found == outcome.values.end() ? Json(nullptr) : Json(found->second);
  }
  return run;
}

Json json_of(const SeedStatistics &seeds)
{
  Json run;
  run["run"] = seeds.run;
  run["against"] = json_of(seeds.abscissa);
  run["seeds"] = seeds.n_seeds;
  run["n"] = seeds.n;
  run["mean"] = json_of(seeds.mean);
  run["standard_deviation"] = json_of(seeds.deviation);
  run["patterns"] = seeds.patterns;
  run["undecided"] = seeds.n_undecided;
  return run;
}

Json json_of(const Interval &interval)
{
  return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

Json json_of(const std::optional<OnsetFit> &fit)
{
  if (!fit)
    return nullptr;
  return {{"exponent", json_of(fit->exponent)},
          {"onset", json_of(fit->onset)},
          {"prefactor", fit->prefactor},
          {"p_fit", fit->p_fit}};
}

Json json_of(const RowOutcome &outcome)
{
  Json row;
  row["runs"] = outcome.row.runs;
  row["quantity"] = outcome.row.quantity;
  row["unit"] = outcome.row.unit();
  row["against"] = outcome.row.against.empty() ? Json(nullptr) : Json(outcome.row.against);
  row["against_unit"] = outcome.row.against.empty() ? Json(nullptr) : Json(outcome.row.against_unit);
  row["expected"] = outcome.expected;
  row["measured"] = outcome.measured;
  row["number"] = json_of(outcome.number);
  if (outcome.row.rule == Rule::onset_exponent)
    row["onset"] = json_of(outcome.onset);
  row["note"] = outcome.note;
  row["verdict"] = to_string(outcome.verdict);
  row["values"] = Json::array();
  for (const SeedStatistics &seeds : outcome.runs)
    row["values"].push_back(json_of(seeds));
  return row;
}

// Entries in which the runs of a study differ, with their value in each run: a number, or a text.
Json varied_entries(const StudyResults &results)
{
  std::vector<std::string> keys;
  for (const StudyRun &run : results.study.runs)
    for (const auto &[key, value] : run.own)
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        keys.push_back(key);
  Json entries = Json::array();
  for (const std::string &key : keys)
  {
    Json values = Json::array();
    bool differ = false;
    std::string last;
    for (const PlannedRun &run : results.plan)
    {
      if (run.run == last)
        continue;
      last = run.run;
      const std::optional<double> number = run.value(key);
      values.push_back(number ? Json(*number) : Json(run.text(key)));
      differ = differ || values.back() != values.front();
    }
    if (differ)
      entries.push_back({{"entry", key}, {"unit", entry_unit(key)}, {"values", std::move(values)}});
  }
  return entries;
}

// One line per run, of at most 60: patterns, speed, wavelength and amplitude over the seeds.
void print_runs(std::ostream &out, const StudyResults &results)
{
  constexpr std::size_t max_printed = 60;
  for (std::size_t i = 0; i < std::min(max_printed, results.study.runs.size()); ++i)
  {
    const std::string &name = results.study.runs[i].name;
    out << name << ": " << statistics(name, pattern_quantity, results.outcomes).text("");
    for (const auto &[quantity, label] : {std::pair<std::string, std::string>{"speed_lagrangian", ""},
                                          {"wavelength", "wavelength "},
                                          {"amplitude", "amplitude "}})
      if (const SeedStatistics seeds = statistics(name, quantity, results.outcomes); seeds.n > 0)
        out << ", " << label << seeds.text(unit_of(quantity));
    out << '\n';
  }
  if (results.study.runs.size() > max_printed)
    out << "... " << results.study.runs.size() << " cases in all: study.csv\n";
}

std::string list_of(const std::vector<std::string> &names)
{
  std::string text;
  for (const std::string &name : names)
    text += (text.empty() ? "" : ", ") + name;
  return text;
}

} // namespace

std::string study_json(const StudyResults &results)
{
  Json document;
  document["title"] = results.study.title;
  document["version"] = output::program_version();
  document["git_commit"] = output::git_commit();
  document["quick"] = results.quick;
  document["verification"] = results.verification;
  document["verified"] = results.is_verified;
  document["settings"] = json_of(results.study.settings);
  document["units"] = Json::object();
  for (const StudyQuantity &quantity : quantities())
    document["units"][quantity.name] = quantity.unit;
  document["runs"] = Json::array();
  for (const StudyRun &run : results.study.runs)
    document["runs"].push_back(
      {{"run", run.name}, {"about", run.about}, {"set", json_of(run.own)}, {"level", run.level}});
  document["swept"] = results.study.swept;
  document["varied"] = varied_entries(results);
  document["left_out"] = results.study.left_out;
  document["pictures"] = results.study.pictures;
  document["seeds"] = Json::array();
  for (std::size_t i = 0; i < results.plan.size(); ++i)
    document["seeds"].push_back(json_of(results.plan[i], results.outcomes[i]));
  document["claims"] = Json::array();
  for (const ClaimResult &claim : results.claims)
  {
    Json rows = Json::array();
    for (const RowOutcome &row : claim.rows)
      rows.push_back(json_of(row));
    document["claims"].push_back({{"claim", claim.claim.claim},
                                  {"paper", claim.claim.paper},
                                  {"note", claim.claim.note},
                                  {"verdict", to_string(claim.verdict())},
                                  {"rows", rows}});
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string study_csv(const StudyResults &results)
{
  std::vector<std::string> columns{"run", "seed", "set", "state", "pattern"};
  for (const StudyQuantity &quantity : quantities())
    columns.push_back(quantity.name + " [" + quantity.unit + "]");
  output::Table table(columns);
  for (const RunOutcome &outcome : results.outcomes)
  {
    std::string set;
    for (const auto &[key, value] : results.study.run(outcome.run).own)
      set += (set.empty() ? "" : "; ") + key + "=" + value;
    std::vector<output::Table::Cell> row{outcome.run, std::to_string(outcome.seed), set, to_string(outcome.state),
                                         outcome.pattern};
    for (const StudyQuantity &quantity : quantities())
    {
      const auto found = outcome.values.find(quantity.name);
      row.push_back(found == outcome.values.end() ? output::Table::Cell(std::string())
                                                  : output::Table::Cell(found->second));
    }
    table.add(row);
  }
  return table.csv();
}

output::Results study_rows(const StudyResults &results)
{
  output::Results rows;
  for (const ClaimResult &claim : results.claims)
    for (const RowOutcome &row : claim.rows)
      if (const auto result = row.result(claim.claim.claim))
        rows.add(*result);
  return rows;
}

void print_table(std::ostream &out, const StudyResults &results)
{
  constexpr std::size_t width = 120;
  const auto paragraph = [&out](const std::string &text, const std::string &first, const std::string &indent)
  {
    std::string lead = first;
    for (const std::string &line : support::wrap_text(text, width - support::width_of(indent)))
    {
      out << lead << line << '\n';
      lead = indent;
    }
  };
  const auto judged = [&paragraph](const RowVerdict verdict, const std::string &text)
  {
    std::string lead = "  " + to_string(verdict);
    lead.resize(17, ' ');
    paragraph(text, lead, std::string(lead.size(), ' '));
  };
  if (results.claims.empty())
    print_runs(out, results);
  for (const ClaimResult &claim : results.claims)
  {
    paragraph(claim.claim.claim + ": " + to_string(claim.verdict()), "", "");
    for (const RowOutcome &row : claim.rows)
    {
      std::string text = list_of(row.row.runs) + ", " + row.row.quantity + ": " + row.measured;
      if (!row.expected.empty())
        text += " [" + row.expected + "]";
      if (!row.note.empty())
        text += " - " + row.note;
      judged(row.verdict, text);
    }
  }
  for (const RunOutcome &outcome : results.outcomes)
    if (outcome.state != RunState::measured)
      paragraph(outcome.run + ", seed " + std::to_string(outcome.seed) + ": " + to_string(outcome.state) +
                  (outcome.problem.empty() ? "" : ": " + outcome.problem),
                "", "  ");
}

void print_plan(std::ostream &out, const Study &study, const std::vector<PlannedRun> &plan, const std::size_t n_cores)
{
  std::size_t widest = 4;
  for (const PlannedRun &run : plan)
    widest = std::max(widest, run.folder().size());
  out << std::left << std::setw(static_cast<int>(widest)) << "run" << std::right << std::setw(10) << "size"
      << std::setw(12) << "evaluations" << std::setw(12) << "core time" << '\n';
  double total = 0.;
  for (const PlannedRun &run : plan)
  {
    total += run.seconds;
    out << std::left << std::setw(static_cast<int>(widest)) << run.folder() << std::right << std::setw(10)
        << std::llround(run.size) << std::setw(12) << std::llround(run.evaluations) << std::setw(10)
        << std::llround(std::ceil(run.seconds)) << " s\n";
  }
  out << plan.size() << " runs, about " << std::llround(std::ceil(total / 60.)) << " core minutes, "
      << std::llround(std::ceil(total / 60. / static_cast<double>(n_cores))) << " minutes on " << n_cores << " cores\n";
  if (study.refine > 0)
    out << "refined " << study.refine << (study.refine == 1 ? " time" : " times")
        << " where neighbours differ, at a cost that depends on the patterns\n";
}

} // namespace latcon::study
