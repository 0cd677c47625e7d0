// Outputs of a comparison of two runs: text, JSON, CSV.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "support/full_precision.h"
#include "support/text_wrap.h"
#include "verification/commands/run_comparison.h"
#include "verification/output/csv.h"
#include "verification/output/quantity_text.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::string number_text(double value, const char *format)
{
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string cell(const std::optional<double> &value, const std::optional<double> &uncertainty, const std::string &unit)
{
  return value ? output::quantity_text(*value, uncertainty, unit) : "-";
}

// Columns two blanks apart, the first row a heading.
std::string table(const std::vector<Row> &rows)
{
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row &row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], support::width_of(row[i]));
  std::string text;
  for (const Row &row : rows)
  {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += (i == 0 ? "" : "  ") + row[i] + std::string(widths[i] - support::width_of(row[i]), ' ');
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

Json json_of(const std::optional<double> &value)
{
  return value ? Json(*value) : Json();
}

std::string csv_of(const std::optional<double> &value)
{
  return value ? support::full_precision(*value) : "";
}

} // namespace

std::string RunComparison::text() const
{
  std::vector<Row> rows{{"quantity", first, second, "difference", "/ uncertainty"}};
  if (first_side != second_side)
    rows.push_back({"side", first_side, second_side, "differs", ""});
  rows.push_back({"pattern", first_pattern, second_pattern, first_pattern == second_pattern ? "none" : "differs", ""});
  for (const QuantityPair &pair : quantities)
    rows.push_back({pair.name, cell(pair.first, pair.first_uncertainty, pair.unit),
                    cell(pair.second, pair.second_uncertainty, pair.unit), cell(pair.difference(), {}, pair.unit),
                    pair.normalized_difference() ? number_text(*pair.normalized_difference(), "%+.1f") : ""});
  std::string text = table(rows) + "\n";
  for (const auto &[run, problem] : {std::pair(first, first_problem), std::pair(second, second_problem)})
    if (!problem.empty())
      text += run + " failed its checks, and is no measurement: " + problem + "\n";
  if (entries.empty())
    text += "The cases have the same entries.\n";
  else
  {
    rows = {{"entry", first, second, "unit"}};
    for (const EntryPair &entry : entries)
      rows.push_back({entry.key, entry.first, entry.second, entry.unit == "1" ? "" : entry.unit});
    text += table(rows);
  }
  if (!paths)
    return text + "\nThe paths have no stretch of X in common.\n";
  const auto length = [this](double value)
  { return output::quantity_text(value, {}, "m") + " (" + number_text(value / spacing, "%.3g") + " d)"; };
  return text + "\nDistance between the paths, X from " + output::quantity_text(paths->X_begin, {}, "m") + " to " +
         output::quantity_text(paths->X_end, {}, "m") + ": rms " + length(paths->rms) + ", largest " +
         length(paths->largest) + " at X = " + output::quantity_text(paths->largest_X, {}, "m") + "\n";
}

std::string RunComparison::json(const std::string &output_directory) const
{
  namespace fs = std::filesystem;
  const auto folder = [&](const std::string &run)
  { return fs::canonical(run).lexically_proximate(fs::canonical(output_directory)).string(); };
  Json document{
    {"first", first}, {"second", second}, {"first_folder", folder(first)}, {"second_folder", folder(second)}};
  document["side"] = {{"first", first_side}, {"second", second_side}};
  document["failed_checks"] = {{"first", first_problem}, {"second", second_problem}};
  document["pattern"] = {{"first", first_pattern}, {"second", second_pattern}};
  document["quantities"] = Json::array();
  for (const QuantityPair &pair : quantities)
    document["quantities"].push_back({{"name", pair.name},
                                      {"unit", pair.unit},
                                      {"first", json_of(pair.first)},
                                      {"first_uncertainty", json_of(pair.first_uncertainty)},
                                      {"second", json_of(pair.second)},
                                      {"second_uncertainty", json_of(pair.second_uncertainty)},
                                      {"difference", json_of(pair.difference())},
                                      {"difference_over_uncertainty", json_of(pair.normalized_difference())}});
  document["entries"] = Json::array();
  for (const EntryPair &entry : entries)
    document["entries"].push_back(
      {{"key", entry.key}, {"unit", entry.unit}, {"first", entry.first}, {"second", entry.second}});
  document["paths"] = nullptr;
  if (paths)
    document["paths"] = {{"X_begin", paths->X_begin},
                         {"X_end", paths->X_end},
                         {"rms_distance", paths->rms},
                         {"largest_distance", paths->largest},
                         {"largest_distance_X", paths->largest_X},
                         {"rms_distance_over_d", paths->rms / spacing},
                         {"largest_distance_over_d", paths->largest / spacing}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string RunComparison::csv() const
{
  std::string text =
    "quantity,unit,first,first_uncertainty,second,second_uncertainty,difference,difference_over_uncertainty\n";
  for (const QuantityPair &pair : quantities)
  {
    text += output::csv_field(pair.name) + "," + output::csv_field(pair.unit);
    for (const std::optional<double> &value : {pair.first, pair.first_uncertainty, pair.second, pair.second_uncertainty,
                                               pair.difference(), pair.normalized_difference()})
      text += "," + csv_of(value);
    text += "\n";
  }
  return text;
}

} // namespace latcon::commands
