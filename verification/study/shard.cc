#include "verification/study/shard.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case_text.h"

namespace latcon::study
{
namespace
{


constexpr std::size_t max_shards = 100000;

// A whole number in all of the text; 0 if it is none.
std::size_t whole_number(const std::string &text)
{
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

} // namespace

Shard parse_shard(const std::string &text)
{
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos)
  {
    const Shard shard{whole_number(text.substr(0, slash)), whole_number(text.substr(slash + 1))};
    if (shard.index >= 1 && shard.index <= shard.count && shard.count <= max_shards)
      return shard;
  }
  throw support::InputError("--shard '" + input::printable(text) +
                            "': expected I/N with 1 <= I <= N <= " + std::to_string(max_shards) + ", for example 3/8");
}

std::vector<std::size_t> runs_of_shard(const std::vector<PlannedRun> &plan, const Shard &shard)
{
  const std::vector<std::size_t> order = longest_first(plan);
  std::vector<std::size_t> runs;
  for (std::size_t i = shard.index - 1; i < order.size(); i += shard.count)
    runs.push_back(order[i]);
  return runs;
}

std::string plan_text(const std::string &title, const std::vector<PlannedRun> &plan, const bool skip_verification,
                      const std::size_t n_shards)
{
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const PlannedRun &run : plan)
    runs.push_back({{"run", run.folder()}, {"side", run.side()}, {"case_sha256", run.case_sha256}});
  nlohmann::ordered_json document{{"study", title}, {"skip_verification", skip_verification}};
  if (n_shards > 0)
    document["shards"] = n_shards;
  document["runs"] = std::move(runs);
  return document.dump(1) + "\n";
}

std::string plan_difference(const std::string &stored, const std::string &wanted)
{
  try
  {
    const nlohmann::ordered_json there = nlohmann::ordered_json::parse(stored), here = nlohmann::ordered_json::parse(wanted);
    const auto differs = [&](const char *key) { return there.at(key) != here.at(key); };
    if (differs("study"))
      return "it is of another study, '" + input::printable(there.at("study").get<std::string>()) + "'";
    if (differs("skip_verification"))
      return "it was begun with another choice of --skip-verification";
    if (here.contains("shards") && differs("shards"))
      return "it was begun with " + there.at("shards").dump() + " shards";
    const nlohmann::ordered_json &old_runs = there.at("runs"), &new_runs = here.at("runs");
    for (std::size_t i = 0; i < std::min(old_runs.size(), new_runs.size()); ++i)
      if (old_runs.at(i) != new_runs.at(i))
        return "the case of run " + new_runs.at(i).at("run").get<std::string>() + " differs";
    if (old_runs.size() != new_runs.size())
      return "it has " + std::to_string(old_runs.size()) + " runs, now there are " + std::to_string(new_runs.size());
    return "";
  }
  catch (const nlohmann::ordered_json::exception &)
  {
    return std::string(plan_file_name) + " is damaged";
  }
}

} // namespace latcon::study
