#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/input/files.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;

// Increases with each change that a reader of the previous document would misunderstand.
constexpr int format_version = 1;

// Names of input::ValueType.
constexpr const char *type_names[] = {"number", "integer", "numbers", "boolean", "word", "text"};

// Value of an entry in the type of JSON that corresponds to its own; `auto` is null.
Json value_of(const input::Declaration &entry, const std::string &text)
{
  if (entry.may_be_auto && text == "auto")
    return nullptr;
  switch (entry.type)
  {
  case input::ValueType::number: // also 1 is a real number
    return Json::parse(text).get<double>();
  case input::ValueType::whole_number:
  case input::ValueType::boolean:
    return Json::parse(text);
  case input::ValueType::numbers:
    return Json::parse("[" + text + "]").get<std::vector<double>>();
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
            {"type", type_names[static_cast<std::size_t>(entry.type)]},
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
  Json document{{"format", "latcon-schema"},
                {"format_version", format_version},
                {"version", output::program_version()},
                {"git_commit", output::git_commit()},
                {"cases", Json::object()}};
  for (const std::string &name : input::shipped_cases())
    document["cases"][name] = input::shipped_case_file(name);
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
