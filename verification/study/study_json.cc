#include "verification/study/study_json.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case_text.h"
#include "verification/input/spelling.h"

namespace latcon::study
{

namespace
{

// Largest nesting depth: deeper than any study, and safe for recursion.
constexpr int max_depth = 64;

// Lists names; long lists are abbreviated, with their number.
std::string abbreviated_list(const std::vector<std::string> &names)
{
  constexpr std::ptrdiff_t most = 60;
  if (names.size() <= most)
    return input::comma_separated(names);
  return input::comma_separated({names.begin(), names.begin() + most}) + ", ... (" + std::to_string(names.size()) +
         " in all)";
}

} // namespace

bool JsonPlace::has(const std::string &key) const
{
  return value_->is_object() && value_->contains(key);
}

JsonPlace JsonPlace::at(const std::string &key) const
{
  return child(value_->at(key), key);
}

nlohmann::ordered_json parse_json(const std::string &text, const std::string &file)
{
  using Json = nlohmann::ordered_json;
  if (const auto problem = input::zero_byte(text, file)) // the parser would stop there
    throw support::InputError(problem->place + ": " + problem->text);
  std::vector<std::set<std::string>> open; // keys of the objects that enclose the current position
  std::vector<std::string> problems;
  const auto check = [&](int depth, Json::parse_event_t event, Json &value)
  {
    if (depth > max_depth)
      throw support::InputError(file + ": not a study: objects and lists are nested deeper than " +
                                std::to_string(max_depth));
    if (event == Json::parse_event_t::object_start)
      open.emplace_back();
    else if (event == Json::parse_event_t::object_end)
      open.pop_back();
    else if (event == Json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
      problems.push_back(file + ": the key '" + input::printable(value.get<std::string>()) +
                         "' occurs twice in an object");
    return true;
  };
  Json document;
  try
  {
    document = Json::parse(text, check);
  }
  catch (const Json::exception &error)
  {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ...": the words after the bracket.
    const std::string what = error.what();
    throw support::InputError(
      file + ": not JSON: " + input::printable(what.substr(std::min(what.size(), what.find(']') + 2)), 200));
  }
  if (!document.is_object())
    problems.push_back(file + ": a study must be a JSON object");
  if (!problems.empty())
    throw support::InputError(problems);
  return document;
}

std::string nearest_hint(const std::string &given, const std::vector<std::string> &known)
{
  const std::string nearest = input::nearest_word(given, known);
  return nearest.empty() ? "" : "; nearest: " + nearest;
}

bool JsonPlace::is_object(const std::vector<std::string> &known) const
{
  if (!value_->is_object())
  {
    problem("must be an object with the keys " + input::comma_separated(known));
    return false;
  }
  for (const auto &[key, member] : value_->items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      problem("unknown key '" + input::printable(key) + "'" + nearest_hint(key, known) +
              "; known: " + input::comma_separated(known));
  return true;
}

std::optional<JsonPlace> JsonPlace::required(const std::string &key) const
{
  if (has(key))
    return at(key);
  problem("the key '" + key + "' is missing");
  return {};
}

std::string JsonPlace::text() const
{
  if (value_->is_string() && !value_->get_ref<const std::string &>().empty())
    return value_->get<std::string>();
  problem("must be a non-empty text, not " + input::printable(value_->dump()));
  return {};
}

std::string JsonPlace::optional_text(const std::string &key) const
{
  if (!has(key) || at(key).value() == "")
    return {};
  return at(key).text();
}

double JsonPlace::number() const
{
  if (value_->is_number())
    return value_->get<double>();
  problem("must be a number, not " + input::printable(value_->dump()));
  return 0.;
}

bool JsonPlace::boolean() const
{
  if (value_->is_boolean())
    return value_->get<bool>();
  problem("must be true or false, not " + input::printable(value_->dump()));
  return false;
}

std::vector<JsonPlace> JsonPlace::list() const
{
  std::vector<JsonPlace> places;
  if (value_->is_array() && !value_->empty())
    for (std::size_t i = 0; i < value_->size(); ++i)
      places.push_back(child((*value_)[i], std::to_string(i + 1)));
  else
    problem("must be a non-empty list, not " + input::printable(value_->dump()));
  return places;
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members() const
{
  std::vector<std::pair<std::string, JsonPlace>> all;
  if (value_->is_object())
    for (const auto &[key, member] : value_->items())
      all.emplace_back(key, child(member, key));
  else
    problem("must be an object, not " + input::printable(value_->dump()));
  return all;
}

std::string JsonPlace::word(const std::vector<std::string> &known, const std::string &what) const
{
  const std::string given = text();
  if (given.empty() || std::find(known.begin(), known.end(), given) != known.end())
    return given;
  problem("'" + input::printable(given) + "' is not a known " + what + nearest_hint(given, known) +
          "; known: " + abbreviated_list(known));
  return {};
}

} // namespace latcon::study
