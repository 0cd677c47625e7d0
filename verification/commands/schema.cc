#include <charconv>
#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "support/ranks.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/input/case_text.h"
#include "verification/input/files.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;

// Increases with each change that a reader of the previous document would misunderstand.
constexpr int format_version = 1;

const char *name_of(input::ValueType type)
{
  switch (type)
  {
  case input::ValueType::number:
    return "number";
  case input::ValueType::whole_number:
    return "integer";
  case input::ValueType::numbers:
    return "numbers";
  case input::ValueType::boolean:
    return "boolean";
  case input::ValueType::word:
    return "word";
  case input::ValueType::text:
    return "text";
  }
  return "";
}

template <typename Number>
Number parse_number(const std::string &text)
{
  Number number{};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size())
    throw std::logic_error("schema: '" + text + "' is no number");
  return number;
}

// Value of an entry in the type of JSON that corresponds to its own; `auto` is null.
Json value_of(const input::Declaration &entry, const std::string &text)
{
  if (entry.may_be_auto && text == "auto")
    return nullptr;
  switch (entry.type)
  {
  case input::ValueType::number:
    return parse_number<double>(text);
  case input::ValueType::whole_number:
    return text[0] == '-' ? Json(parse_number<std::int64_t>(text)) : Json(parse_number<std::uint64_t>(text));
  case input::ValueType::boolean:
    return text == "true";
  case input::ValueType::numbers:
  {
    Json list = Json::array();
    for (std::size_t at = 0; !text.empty() && at <= text.size();)
    {
      const std::size_t end = std::min(text.find(',', at), text.size());
      list.push_back(parse_number<double>(input::trimmed(text.substr(at, end - at))));
      at = end + 1;
    }
    return list;
  }
  default:
    return text;
  }
}

// The bounds that exist, under the keywords of JSON Schema.
Json range_of(const input::Declaration &entry)
{
  Json range = Json::object();
  const auto put = [&](const input::Range::Bound &bound, const char *included, const char *excluded)
  {
    if (!std::isfinite(bound.value))
      return;
    Json &place = range[bound.included ? included : excluded];
    if (entry.type == input::ValueType::whole_number)
      place = static_cast<std::int64_t>(bound.value);
    else
      place = bound.value;
  };
  put(entry.range->lower, "minimum", "exclusive_minimum");
  put(entry.range->upper, "maximum", "exclusive_maximum");
  if (entry.largest_whole)
    range["maximum"] = *entry.largest_whole;
  return range;
}

Json describe(const input::Declaration &entry)
{
  const bool required = entry.presence == input::Presence::required;
  Json item{{"section", entry.section},
            {"name", entry.name},
            {"type", name_of(entry.type)},
            {"unit", entry.unit.empty() ? Json() : Json(entry.unit)},
            {"required", required}};
  if (entry.range)
    item["range"] = range_of(entry);
  if (entry.may_be_auto)
    item["auto"] = true;
  if (entry.type == input::ValueType::word)
    item["words"] = entry.words;
  if (!required)
    item["default"] = value_of(entry, entry.default_text);
  item["allowed"] = entry.rule;
  item["documentation"] = entry.documentation;
  return item;
}

// Files of the shipped cases by name.
Json shipped_case_files()
{
  Json cases = Json::object();
  for (const std::string &name : input::shipped_cases())
    cases[name] = input::shipped_case_file(name);
  return cases;
}

} // namespace

nlohmann::ordered_json schema_document(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  if (options.case_is_given)
    read_case(options, input, parameters);
  else if (options.overrides.empty())
    input.declare(parameters);
  else
    throw support::InputError("--set replaces entries of a case; give one: latcon schema CASE --set ...");
  if (options.case_is_given)
    parameters.finish(); // an invalid case has no material
  const std::vector<input::Declaration> entries = parameters.declarations();
  Json document;
  document["format"] = "latcon-schema";
  document["format_version"] = format_version;
  document["version"] = output::program_version();
  document["git_commit"] = output::git_commit();
  document["cases"] = shipped_case_files();
  const lattice::Material material = input.material();
  for (const claims::Claim &claim : claim_registry())
    document["claims"].push_back({{"name", claim.name},
                                  {"title", claim.title},
                                  {"default", claim.is_default_for(material)},
                                  {"before_fracture", claim.is_before_fracture(material)}});
  for (const input::Declaration &entry : entries)
    document["entries"].push_back(describe(entry));
  if (options.case_is_given)
  {
    Json values = Json::object();
    for (const input::Declaration &entry : entries)
      values[entry.key()] = value_of(entry, parameters.value(entry.key()));
    document["case"] = {
      {"file", options.case_file}, {"values", std::move(values)}, {"resolved", parameters.resolved_text()}};
  }
  return document;
}

support::ExitCode print_schema(const input::Options &options)
{
  const Json document = schema_document(options);
  if (support::is_root_rank())
    std::cout << document.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  return support::ExitCode::done;
}

} // namespace latcon::commands
