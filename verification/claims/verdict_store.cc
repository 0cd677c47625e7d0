#include "verification/claims/verdict_store.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "support/atomic_file.h"
#include "support/errors.h"
#include "support/folder_lock.h"
#include "verification/claims/claim_inputs.h"
#include "verification/input/files.h"
#include "verification/input/sha256.h"
#include "verification/output/output_file.h"
#include "verification/output/run_info.h"

namespace latcon::claims
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr int format = 2;                      // of the file
constexpr off_t largest_file = off_t(1) << 28; // [byte]; no check leaves as much

constexpr mode_t writable_by_others = S_IWGRP | S_IWOTH;

// Names of files in the folder itself, without path components.
bool is_table_name(const std::string &name)
{
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
}

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
std::map<std::string, std::string> libraries()
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

std::string checksum(Json document)
{
  document.erase("checksum");
  return input::sha256(document.dump());
}

// Parses a number of results.json.
std::optional<double> number(const Json &value)
{
  if (value.is_null())
    return {};
  if (value == "nan")
    return std::numeric_limits<double>::quiet_NaN();
  if (value == "inf" || value == "-inf")
    return value == "inf" ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  return value.get<double>();
}

output::Result row(const Json &entry)
{
  output::Result result{entry.at("claim"),
                        entry.at("quantity"),
                        entry.at("unit"),
                        number(entry.at("lattice")),
                        number(entry.at("continuum")),
                        number(entry.at("theory")),
                        number(entry.at("error")),
                        {number(entry.at("tolerance")), entry.at("reason")},
                        entry.at("gate")};
  if (entry.at("verdict") != to_string(result.verdict()))
    throw UnusableVerdicts("a verdict in it is not that of its numbers");
  return result;
}

} // namespace

VerdictKey::VerdictKey(std::string inputs) : text(std::move(inputs)), hash(input::sha256(text)) {}

VerdictKey verdict_key(const input::Case &input, const std::vector<Claim> &claims, const bridge::Laws &laws, bool quick,
                       unsigned int n_ranks)
{
  const bool is_about_program =
    !claims.empty() &&
    std::all_of(claims.begin(), claims.end(), [](const Claim &claim) { return claim.is_about_program; });
  std::string text = "program=" + output::program_hash() + "\n";
  std::vector<std::string> entries;
  for (const Claim &claim : claims)
  {
    text += "claim=" + claim.name + "\n";
    entries.insert(entries.end(), claim.entries.begin(), claim.entries.end());
  }
  text += std::string("quick=") + (quick ? "true" : "false") + "\n";
  if (is_about_program)
    return VerdictKey(text);
  text += "laws="; // they decide which rows can fail
  for (const bridge::Law law : laws)
    text += std::to_string(static_cast<int>(law)) + ",";
  text += "\nranks=" + std::to_string(n_ranks) + "\n";
  return VerdictKey(text + claim_inputs_text(input, entries));
}

Verdicts::Verdicts(const ClaimOutcome &outcome) : results(outcome.results), checked_at(now())
{
  for (const auto &[name, table] : outcome.tables)
    tables[name] = table.csv();
}

void Verdicts::write_tables(const std::string &folder) const
{
  for (const auto &[name, csv] : tables)
    output::write_file((std::filesystem::path(folder) / (name + ".csv")).string(), csv);
}

std::string acceptance_problem(const output::Results &results, const std::vector<Claim> &required)
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
  Json document;
  document["format"] = format;
  document["hash"] = key.hash;
  document["inputs"] = key.text;
  document["checked_at"] = verdicts.checked_at;
  document["version"] = output::program_version();
  document["git_commit"] = output::git_commit();
  document["hardware_threads"] = std::thread::hardware_concurrency();
  document["libraries"] = libraries();
  document["results"] = Json::parse(verdicts.results.json());
  document["tables"] = verdicts.tables;
  document["checksum"] = checksum(document);
  return document.dump(2) + "\n";
}

Verdicts read_verdicts(const VerdictKey &key, const std::string &text, const bool libraries_may_be_updated)
{
  Verdicts verdicts;
  try
  {
    const Json document = Json::parse(text);
    if (document.at("format") != format)
      throw UnusableVerdicts("it has another format");
    if (document.at("hash") != key.hash || document.at("inputs") != key.text)
      throw UnusableVerdicts("it belongs to other inputs");
    if (document.at("checksum") != checksum(document))
      throw UnusableVerdicts("its checksum is wrong");
    for (const auto &[file, present] : document.at("libraries").get<std::map<std::string, std::string>>())
      if (const std::string now = stamp(file); now.empty() || (now != present && !libraries_may_be_updated))
        throw UnusableVerdicts("the library " + file + " has changed");
    for (const Json &entry : document.at("results").at("claims"))
      verdicts.results.add(row(entry));
    verdicts.tables = document.at("tables").get<std::map<std::string, std::string>>();
    for (const auto &[name, csv] : verdicts.tables)
      if (!is_table_name(name))
        throw UnusableVerdicts("it has a table of an impossible name");
    verdicts.checked_at = document.at("checked_at");
  }
  catch (const Json::exception &)
  {
    throw UnusableVerdicts("it is damaged");
  }
  return verdicts;
}

std::optional<std::string> VerdictStore::folder_of_user()
{
  const char *cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') // relative paths must be ignored
    return std::string(cache) + "/latcon/verdicts";
  const char *home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/')
    return std::string(home) + "/.cache/latcon/verdicts";
  return {};
}

std::string shipped_verdicts(const VerdictKey &key)
{
  try
  {
    const std::string text = VerdictStore(input::data_folder() + "/verdicts").read(key).value_or("");
    if (text.empty())
      return "";
    const Verdicts verdicts = read_verdicts(key, text, true);
    return verdicts.results.all_hold() ? verdicts_text(key, verdicts) : ""; // with the libraries of here
  }
  catch (const UnusableVerdicts &) // another BLAS, say: as if there were none
  {
    return "";
  }
}

std::string VerdictStore::path(const VerdictKey &key) const
{
  return folder_ + "/" + key.hash + ".json";
}

std::optional<std::string> VerdictStore::read(const VerdictKey &key) const
{
  const int descriptor = open(path(key).c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0 && (errno == ENOENT || errno == ENOTDIR))
    return {};
  struct stat status = {};
  const char *problem = nullptr;
  if (descriptor < 0 || fstat(descriptor, &status) != 0)
    problem = "it cannot be read";
  else if (!S_ISREG(status.st_mode) || status.st_size > largest_file)
    problem = "it is no file of verdicts";
  else if ((status.st_uid != geteuid() && status.st_uid != 0) || (status.st_mode & writable_by_others) != 0)
    problem = "it belongs to another user, or others may write it";
  std::string text;
  if (problem == nullptr) // the file whose owner is known, under any name
  {
    std::ifstream file("/proc/self/fd/" + std::to_string(descriptor), std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    problem = !file ? "it cannot be read" : text.empty() ? "it is empty" : nullptr;
  }
  close(descriptor);
  if (problem != nullptr)
    throw UnusableVerdicts(problem);
  return text;
}

void VerdictStore::write(const VerdictKey &key, const std::string &text) const
{
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error)
    throw support::OutputError(folder_, error.message());
  // Other runs may be writing here, for milliseconds; older parts were left by killed runs.
  support::remove_stale_parts(folder_, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  output::write_file(path(key), text);
  chmod(path(key).c_str(), S_IRUSR | S_IWUSR); // read() refuses other modes, whatever the umask
}

std::shared_ptr<void> VerdictStore::wait_for_turn(const VerdictKey &key) const
{
  constexpr std::chrono::minutes patience(10);
  const std::filesystem::path folder = folder_ + "/" + key.hash + ".checking";
  try
  {
    std::filesystem::create_directories(folder);
    return {new support::FolderLock(folder, patience), [folder](support::FolderLock *lock)
            {
              std::error_code ignored; // an empty folder does no harm
              std::filesystem::remove_all(folder, ignored);
              delete lock;
            }};
  }
  catch (const std::runtime_error &) // FolderInUse, OutputError, std::filesystem::filesystem_error
  {
    return nullptr;
  }
}

} // namespace latcon::claims
