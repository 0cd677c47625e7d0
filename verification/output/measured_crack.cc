#include "verification/output/measured_crack.h"

#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/output/results.h"

namespace latcon::output
{
namespace
{

// Reads the JSON object in a file; returns an empty object if the file is missing or corrupt.
nlohmann::json object_in(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  return document.is_object() ? document : nlohmann::json::object();
}

void read_numbers(const nlohmann::json &object, const CrackQuantity::Source source, Values &values)
{
  for (const CrackQuantity &quantity : crack_quantities())
    if (quantity.source == source && object.contains(quantity.name) && object[quantity.name].is_number())
      values[quantity.name] = object[quantity.name].get<double>();
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
    if (kind != to_string(RowKind::reference))
      rows +=
        (rows.empty() ? "" : "; ") + row + " (" + (kind.is_string() ? kind.get<std::string>() : kind.dump()) + ")";
  return rows;
}

} // namespace

std::optional<MeasuredCrack> read_measured_crack(const std::string &folder, const double spacing)
{
  const nlohmann::json info = object_in(folder + "/run.json"), crack = object_in(folder + "/crack.json");
  const auto exit_code = info.find("exit_code"), pattern = crack.find("pattern");
  const bool failed = exit_code != info.end() && *exit_code == static_cast<int>(support::ExitCode::claim_failed);
  if (exit_code == info.end() || (!failed && *exit_code != static_cast<int>(support::ExitCode::done)) ||
      pattern == crack.end() || !pattern->is_string() || *pattern == "")
    return {};
  MeasuredCrack measured{pattern->get<std::string>(), failed ? unfit_rows(info) : "", {}};
  read_numbers(crack, CrackQuantity::Source::crack, measured.values);
  read_numbers(object_in(folder + "/near_tip.json"), CrackQuantity::Source::near_tip, measured.values);
  add_derived(measured.values, spacing);
  return measured;
}

} // namespace latcon::output
