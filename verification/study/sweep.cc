#include "verification/study/sweep.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "support/full_precision.h"
#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/input/sha256.h"
#include "verification/input/spelling.h"
#include "verification/input/units.h"

namespace latcon::study
{
namespace
{

constexpr std::size_t max_runs = 100000; // of a sweep, with all seeds
constexpr std::size_t n_digest = 16;     // hexadecimal digits: of 100,000 runs two agree with a probability of 3e-10

[[noreturn]] void refuse(const std::string &text, const std::string &reason)
{
  throw support::InputError("sweep '" + input::printable(text) + "': " + reason);
}

std::vector<std::string> split(const std::string &text, const char separator)
{
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  for (std::string &part : parts)
    part = input::trimmed(part);
  return parts;
}

// Number and unit of one end of a grid.
struct End
{
  double number;
  std::string unit; // as given; empty if there is none
};

End parse_end(const std::string &text, const std::string &part, const std::string &name, const std::string &unit)
{
  if (const std::string wrong = input::read_quantity(part, unit).wrong; !wrong.empty())
    refuse(text, name + " '" + input::printable(part) + "': " + wrong);
  End end{};
  // A plus sign, which read_quantity() allows, is no part of a number for from_chars().
  const char *const first = part.data() + (part.front() == '+' ? 1 : 0);
  const auto [rest, error] = std::from_chars(first, part.data() + part.size(), end.number);
  if (error != std::errc())
    refuse(text, name + " '" + input::printable(part) + "' is not a number");
  end.unit = input::trimmed(rest);
  return end;
}

std::vector<std::string> grid(const std::string &text, const std::string &values, const std::string &unit)
{
  const std::vector<std::string> parts = split(values, ':');
  if (parts.size() != 3)
    refuse(text, "expected START:STOP:COUNT, for example 1.5:1.9:5; '" + input::printable(values) + "' has " +
                   std::to_string(parts.size()) + " parts");
  for (std::size_t i = 0; i < 3; ++i)
    if (parts[i].empty())
      refuse(text, std::string(i == 0 ? "START" : i == 1 ? "STOP" : "COUNT") + " is empty");
  const End start = parse_end(text, parts[0], "START", unit), stop = parse_end(text, parts[1], "STOP", unit);
  if (start.unit != stop.unit)
    refuse(text, "START and STOP must have the same unit, or none; '" + input::printable(parts[0]) + "' and '" +
                   input::printable(parts[1]) + "' differ");
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(parts[2].data(), parts[2].data() + parts[2].size(), count);
  if (error != std::errc() || end != parts[2].data() + parts[2].size() || count < 2 || count > max_runs)
    refuse(text,
           "COUNT '" + input::printable(parts[2]) + "' must be a whole number from 2 to " + std::to_string(max_runs));
  if (start.number == stop.number)
    refuse(text, "START and STOP must differ");
  if (!std::isfinite(stop.number - start.number))
    refuse(text, "START '" + input::printable(parts[0]) + "' and STOP '" + input::printable(parts[1]) +
                   "' are too far apart for floating-point numbers");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    // Twelve digits of the larger end are also where rounding leaves 1e-17 in place of 0.
    const double step = std::max(std::abs(start.number), std::abs(stop.number)) * 1e-12;
    const double value = start.number + share * (stop.number - start.number);
    found.push_back(plain_number(std::abs(value) < step ? 0. : value) + (start.unit.empty() ? "" : " " + start.unit));
  }
  return found;
}

// Value as a text that is the same for equal values: of a number its SI value (0 for -0), of all others the text
// itself.
std::string canonical(const std::string &value, const input::Declaration &entry)
{
  if (entry.type != input::ValueType::number && entry.type != input::ValueType::whole_number)
    return value;
  const input::ParsedNumber number = input::read_quantity(value, entry.unit.empty() ? "1" : entry.unit);
  return number.wrong.empty() ? support::full_precision(number.value + 0.) : value;
}

// Letters that a name of a run may have: blanks become `blank`, others '-'.
std::string name_of(const std::string &text, const std::string &blank)
{
  std::string name;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-')
      name += c;
    else if (c == ' ')
      name += blank;
    else if (c != '+')
      name += '-';
  return name;
}

// Name of an entry in the names of runs: with its section if another swept entry has the same name.
std::string short_name(const Sweep &sweep, const std::vector<Sweep> &all)
{
  const auto tail = [](const std::string &entry) { return entry.substr(entry.find('/') + 1); };
  const auto same = [&](const Sweep &other) { return tail(other.entry) == tail(sweep.entry); };
  return name_of(std::count_if(all.begin(), all.end(), same) > 1 ? sweep.entry : tail(sweep.entry), "-");
}

// Name of a run whose values are too long for one, or whose name another has: the same in each study with this run.
std::string shortened(const SweptCase &swept)
{
  std::string settings;
  for (const auto &[key, value] : swept.set)
    settings += key + "=" + value + "\n";
  return swept.name.substr(0, max_name_length - n_digest - 1) + "-" + input::sha256(settings).substr(0, n_digest);
}

} // namespace

std::string plain_number(const double number)
{
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.12g", number);
  return digits.data();
}

bool is_continuous(const Sweep &sweep)
{
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  const std::vector<input::Declaration> declarations = parameters.declarations();
  const auto entry = std::find_if(declarations.begin(), declarations.end(),
                                  [&sweep](const input::Declaration &declaration)
                                  { return declaration.section + "/" + declaration.name == sweep.entry; });
  return entry != declarations.end() && entry->type == input::ValueType::number &&
         std::all_of(sweep.values.begin(), sweep.values.end(),
                     [&entry](const std::string &value)
                     { return input::read_quantity(value, entry->unit.empty() ? "1" : entry->unit).wrong.empty(); });
}

SweptCase combination(const std::vector<Sweep> &sweeps, const std::vector<std::size_t> &at)
{
  SweptCase found;
  for (std::size_t i = 0; i < sweeps.size(); ++i)
  {
    const std::string &value = sweeps[i].values.at(at.at(i));
    found.set.emplace_back(sweeps[i].entry, value);
    found.name += (found.name.empty() ? "" : "_") + short_name(sweeps[i], sweeps) + "-" + name_of(value, "");
  }
  return found;
}

Sweep parse_sweep(const std::string &text)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    refuse(text, "expected Section/Name=START:STOP:COUNT or Section/Name=VALUE,VALUE,...");
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  Sweep sweep{input::trimmed(text.substr(0, equals)), {}};
  const std::string values = input::trimmed(text.substr(equals + 1));
  std::vector<std::string> known;
  const input::Declaration *entry = nullptr;
  const std::vector<input::Declaration> declarations = parameters.declarations();
  for (const input::Declaration &declaration : declarations)
  {
    known.push_back(declaration.section + "/" + declaration.name);
    if (known.back() == sweep.entry)
      entry = &declaration;
  }
  if (entry == nullptr)
  {
    const std::string nearest = input::nearest_word(sweep.entry, known);
    refuse(text, "'" + input::printable(sweep.entry) + "' is not an entry of a case" +
                   (nearest.empty() ? "; latcon entries lists them" : "; nearest: " + nearest));
  }
  if (sweep.entry == seed_entry)
    refuse(text, "seeds are set by --seeds");
  if (entry->type == input::ValueType::numbers)
    refuse(text, sweep.entry + " is a list; to vary lists, write a study file");
  if (values.find(':') != std::string::npos)
  {
    if (entry->type != input::ValueType::number && entry->type != input::ValueType::whole_number)
      refuse(text, sweep.entry + " is not a number; give its values separated by commas");
    sweep.values = grid(text, values, entry->unit.empty() ? "1" : entry->unit);
  }
  else
    sweep.values = split(values, ',');
  if (sweep.values.size() < 2)
    refuse(text, "expected two values or more; for one value use --set");
  std::map<std::string, std::string> earlier; // values by their canonical form
  for (std::size_t i = 0; i < sweep.values.size(); ++i)
  {
    const std::string &value = sweep.values[i];
    if (value.empty())
      refuse(text, "value " + std::to_string(i + 1) + " is empty");
    const auto [same, is_new] = earlier.emplace(canonical(value, *entry), value);
    if (!is_new)
      refuse(text, "the value " + input::printable(value) + " is given twice" +
                     (same->second == value ? "" : ", also as " + input::printable(same->second)));
  }
  return sweep;
}

std::vector<SweptCase> combinations(const std::vector<Sweep> &sweeps, const std::size_t n_seeds)
{
  std::size_t n_cases = 1;
  for (std::size_t i = 0; i < sweeps.size(); ++i)
  {
    const std::string &entry = sweeps[i].entry;
    if (std::any_of(sweeps.begin(), sweeps.begin() + static_cast<std::ptrdiff_t>(i),
                    [&entry](const Sweep &other) { return other.entry == entry; }))
      throw support::InputError("sweep: " + entry + " is swept twice");
    n_cases = n_cases > max_runs ? n_cases : n_cases * sweeps[i].values.size();
  }
  if (n_cases > max_runs / n_seeds)
    throw support::InputError("sweep: more than " + std::to_string(max_runs) + " runs, with " +
                              std::to_string(n_seeds) + " seeds for each combination of values");
  std::vector<SweptCase> cases;
  std::set<std::string> names;
  std::vector<std::size_t> at(sweeps.size(), 0); // index of the value of each sweep
  while (cases.size() < n_cases)
  {
    SweptCase found = combination(sweeps, at);
    if (found.name.size() > max_name_length || !names.insert(found.name).second)
      found.name = shortened(found);
    cases.push_back(std::move(found));
    for (std::size_t i = sweeps.size(); i > 0 && ++at[i - 1] == sweeps[i - 1].values.size(); --i)
      at[i - 1] = 0;
  }
  return cases;
}

std::string sweep_study(const std::vector<std::string> &sweeps, const std::string &case_name, const std::string &base,
                        const Settings &settings, const std::size_t n_seeds)
{
  using Json = nlohmann::ordered_json;
  std::string entries;
  Json set = Json::object();
  for (const auto &[key, value] : settings)
    set[key] = value;
  for (const std::string &text : sweeps)
  {
    const std::string entry = parse_sweep(text).entry;
    if (set.contains(entry))
      throw support::InputError("--set: " + entry + " is also an entry of --sweep");
    entries += (entries.empty() ? "" : ", ") + entry;
  }
  Json document{{"title", "Sweep of " + entries + " (" + case_name + ")"}, {"base", base}};
  if (!set.empty())
    document["set"] = set;
  std::vector<std::size_t> seeds(std::max<std::size_t>(n_seeds, 1));
  std::iota(seeds.begin(), seeds.end(), 1);
  document["seeds"] = seeds;
  document["sweep"] = sweeps;
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace latcon::study
