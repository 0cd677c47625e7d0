#include "verification/claims/verdict_store.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>
#include <system_error>

#include <link.h>

#include <nlohmann/json.hpp>

#include "support/atomic_file.h"
#include "verification/input/files.h"
#include "verification/output/output_file.h"
#include "verification/output/run_info.h"

namespace latcon::claims
{
namespace
{

using Json = nlohmann::ordered_json;

// Size and time of the last change of a file, which packages set: the same on all nodes of a cluster. Empty if there is
// no such file.
std::string stamp(const std::filesystem::path &file)
{
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  const auto time = std::filesystem::last_write_time(file, error);
  return error ? "" : std::to_string(size) + " bytes, " + std::to_string(time.time_since_epoch().count());
}

// The shared libraries of this process and their stamps. The rest is the program and its module, whose hash is in the
// key.
std::map<std::string, std::string> loaded_libraries()
{
  std::map<std::string, std::string> list;
  static const std::filesystem::path module = input::module_file();
  dl_iterate_phdr(
    [](dl_phdr_info *library, std::size_t, void *stamps)
    {
      const std::filesystem::path file = library->dlpi_name;
      if (file.has_parent_path() && file != module) // neither the program itself nor the vdso
        (*static_cast<std::map<std::string, std::string> *>(stamps))[file] = stamp(file);
      return 0;
    },
    &list);
  return list;
}

std::string now()
{
  const std::time_t seconds = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

} // namespace

Verdicts::Verdicts(const ClaimOutcome &outcome)
  : results(outcome.results), libraries(loaded_libraries()), checked_at(now())
{
  for (const auto &[name, table] : outcome.tables)
    tables[name] = table.csv();
}

void Verdicts::write_tables(const std::string &folder) const
{
  for (const auto &[name, csv] : tables)
    output::write_file((std::filesystem::path(folder) / (name + ".csv")).string(), csv);
}

std::string Verdicts::library_problem(const bool may_be_updated) const
{
  for (const auto &[file, then] : libraries)
    if (const std::string here = stamp(file); here.empty() || (here != then && !may_be_updated))
      return "the library " + file + " has changed";
  return "";
}

std::string Verdicts::acceptance_problem(const std::vector<Claim> &required) const
{
  const auto is_required = [&](const std::string &name)
  { return std::any_of(required.begin(), required.end(), [&](const Claim &claim) { return claim.name == name; }); };
  std::set<std::string> judged;
  for (const output::Result &row : results.rows())
  {
    if (!is_required(row.claim))
      return "a row belongs to the claim " + row.claim + ", which was not asked for";
    if (row.gate && row.verdict() != output::Verdict::reported)
      judged.insert(row.claim);
  }
  for (const Claim &claim : required)
    if (judged.count(claim.name) == 0)
      return "the claim " + claim.name + " judged nothing";
  return "";
}

std::string verdicts_text(const VerdictKey &key, const Verdicts &verdicts)
{
  const Json document = {{"hash", key.hash},
                         {"inputs", key.text},
                         {"checked_at", verdicts.checked_at},
                         {"version", output::program_version()},
                         {"git_commit", output::git_commit()},
                         {"libraries", verdicts.libraries},
                         {"results", Json::parse(verdicts.results.json())},
                         {"tables", verdicts.tables}};
  return document.dump(2) + "\n";
}

Verdicts read_verdicts(const VerdictKey &key, const std::string &text)
{
  Verdicts verdicts;
  try
  {
    const Json document = Json::parse(text);
    if (document.at("inputs") != key.text)
      throw UnusableVerdicts("it belongs to other inputs");
    verdicts.results = output::Results::read(document.at("results").dump());
    document.at("tables").get_to(verdicts.tables);
    document.at("libraries").get_to(verdicts.libraries);
    document.at("checked_at").get_to(verdicts.checked_at);
  }
  catch (const Json::exception &)
  {
    throw UnusableVerdicts("it is damaged");
  }
  catch (const std::logic_error &) // a text in the place of a number
  {
    throw UnusableVerdicts("it is damaged");
  }
  for (const auto &[name, csv] : verdicts.tables)
    if (std::filesystem::path(name).filename() != name || name.empty())
      throw UnusableVerdicts("it has a table of an impossible name");
  return verdicts;
}

std::optional<std::string> verdicts_folder_of_user()
{
  const char *cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') // relative paths must be ignored
    return std::string(cache) + "/latcon/verdicts";
  const char *home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/')
    return std::string(home) + "/.cache/latcon/verdicts";
  return {};
}

std::string verdicts_file(const std::string &folder, const VerdictKey &key)
{
  return folder + "/" + key.hash + ".json";
}

void store_verdicts(const std::string &folder, const VerdictKey &key, const Verdicts &verdicts)
{
  support::create_folders(folder);
  // Other runs may be writing here, for milliseconds; older parts were left by killed runs.
  support::remove_stale_parts(folder, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  output::write_file(verdicts_file(folder, key), verdicts_text(key, verdicts));
}

std::optional<std::string> stored_text(const std::string &file)
{
  if (!std::filesystem::exists(file))
    return {};
  // A pipe would block.
  const input::InputFile stored =
    std::filesystem::is_regular_file(file) ? input::read_input_file(file) : input::InputFile{"", "it is no file"};
  if (!stored.problem.empty())
    throw UnusableVerdicts("it cannot be read");
  return stored.text;
}

} // namespace latcon::claims
