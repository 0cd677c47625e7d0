#include "verification/study/run_outcome.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case_text.h"
#include "verification/output/results.h"
#include "verification/output/run_info.h"

namespace latcon::study
{
namespace
{

std::string content(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Reads the JSON object in a file; returns an empty object if the file is missing or corrupt.
nlohmann::json object_in(const std::string &path)
{
  nlohmann::json document = nlohmann::json::parse(content(path), nullptr, false);
  return document.is_object() ? document : nlohmann::json::object();
}

template <typename Value>
Value value_or(const nlohmann::json &object, const std::string &key, const Value &otherwise)
{
  try
  {
    return object.value(key, otherwise);
  }
  catch (const nlohmann::json::exception &) // of another type, or null
  {
    return otherwise;
  }
}

void read_numbers(const nlohmann::json &object, const StudyQuantity::Source source, Values &values)
{
  for (const StudyQuantity &quantity : quantities())
    if (quantity.source == source && object.contains(quantity.name) && object[quantity.name].is_number())
      values[quantity.name] = object[quantity.name].get<double>();
}

// Returns the last message of the program, which may have several lines: everything from the last line that begins with
// the name of the program, or the last line.
std::string last_words(const std::string &text)
{
  const std::string all = "\n" + input::trimmed(text);
  std::size_t begin = all.rfind("\nlatcon: ");
  if (begin == std::string::npos)
    begin = all.find_last_of("\r\n");
  std::string words = all.substr(begin + 1);
  for (std::size_t at = 0; (at = words.find('\n', at)) != std::string::npos;)
    words.replace(at, 1, "; ");
  return input::printable(words, 300);
}

// Rows that failed and compare nothing with published values, each with its kind. A run that does not name its failed
// rows is no measurement either.
std::string unfit_rows(const nlohmann::json &info)
{
  const auto failed = info.find("failed_rows");
  if (failed == info.end() || !failed->is_object() || failed->empty())
    return "run.json does not say which rows failed";
  std::string rows;
  for (const auto &[row, kind] : failed->items())
    if (kind != to_string(output::RowKind::reference))
      rows +=
        (rows.empty() ? "" : "; ") + row + " (" + (kind.is_string() ? kind.get<std::string>() : kind.dump()) + ")";
  return rows;
}

} // namespace

std::string to_string(const RunState state)
{
  switch (state)
  {
  case RunState::measured:
    return "measured";
  case RunState::refused:
    return "refused: verification";
  case RunState::rejected:
    return "failed its checks";
  case RunState::failed:
    return "failed";
  default:
    return "not run";
  }
}

RunOutcome read_crack(const PlannedRun &run, const std::string &folder, const std::optional<int> exit_code)
{
  RunOutcome outcome;
  outcome.run = run.run;
  outcome.seed = run.seed;
  if (run.zeta)
    outcome.values["zeta"] = *run.zeta;
  const nlohmann::json info = object_in(folder + "/run.json");
  outcome.exit_code = exit_code.value_or(value_or(info, "exit_code", -1));
  outcome.wall_time = value_or(info, "wall_time_total_s", 0.);
  const nlohmann::json crack = object_in(folder + "/crack.json");
  const bool ended = outcome.exit_code == static_cast<int>(support::ExitCode::done) ||
                     outcome.exit_code == static_cast<int>(support::ExitCode::claim_failed);
  outcome.pattern = value_or(crack, "pattern", std::string());
  if (ended && !outcome.pattern.empty())
  {
    if (outcome.exit_code == static_cast<int>(support::ExitCode::claim_failed))
      outcome.problem = unfit_rows(info);
    outcome.state = RunState::measured;
    outcome.reason = value_or(crack, "reason", std::string());
    read_numbers(crack, StudyQuantity::Source::crack, outcome.values);
    read_numbers(object_in(folder + "/near_tip.json"), StudyQuantity::Source::near_tip, outcome.values);
    add_derived(outcome.values, run.spacing);
    return outcome;
  }
  outcome.pattern.clear();
  outcome.state =
    outcome.exit_code == static_cast<int>(support::ExitCode::claim_failed) ? RunState::refused : RunState::failed;
  outcome.problem = last_words(content(folder + "/log.txt"));
  return outcome;
}

RunOutcome read_outcome(const PlannedRun &run, const std::string &folder, const std::optional<int> exit_code)
{
  RunOutcome outcome = read_crack(run, folder, exit_code);
  if (outcome.state != RunState::measured || outcome.problem.empty())
    return outcome;
  outcome.state = RunState::rejected;
  outcome.pattern.clear();
  outcome.reason.clear();
  outcome.values.clear();
  if (run.zeta)
    outcome.values["zeta"] = *run.zeta;
  return outcome;
}

bool is_begun(const PlannedRun &run, const std::string &folder, const bool skip_verification)
{
  const nlohmann::json info = object_in(folder + "/run.json");
  // Cracks of the lattice do not name their side. A run that has not ended has no crack.json; its checkpoint names the
  // command.
  const nlohmann::json crack = object_in(folder + "/crack.json");
  if (!crack.empty() && value_or(crack, "side", std::string("lattice")) != run.side())
    return false;
  // A killed run has not recorded whether it was verified; it verifies its case when it continues. The case comes last,
  // because it takes milliseconds to resolve.
  return value_or(info, "program_hash", std::string()) == output::program_hash() &&
         value_or(info, "skip_verification", skip_verification) == skip_verification &&
         content(folder + "/case.prm") == run.case_text();
}

bool is_finished(const PlannedRun &run, const std::string &folder, const bool skip_verification)
{
  if (!is_begun(run, folder, skip_verification))
    return false;
  const RunState state = read_outcome(run, folder).state;
  return state == RunState::measured || state == RunState::rejected;
}

} // namespace latcon::study
