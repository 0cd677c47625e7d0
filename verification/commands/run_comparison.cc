#include "verification/commands/run_comparison.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case.h"
#include "verification/input/input_file.h"
#include "verification/output/measured_crack.h"

namespace latcon::commands
{
namespace
{

// Compared data of one run.
struct CrackRun
{
  output::MeasuredCrack crack;
  std::vector<PathPoint> path;
  std::map<std::string, std::string> entries; // as a case file would hold them
  std::map<std::string, std::string> units;   // of the entries
  double spacing = 0.;                        // [m]
  std::string side;                           // that broke
};

std::string text_of(const std::string &path)
{
  input::InputFile file = input::read_input_file(path);
  if (!file.problem.empty())
    throw support::InputError(path + ": cannot be read: " + file.problem);
  return std::move(file.text);
}

std::vector<std::string> fields_of(const std::string &line)
{
  std::vector<std::string> fields;
  std::istringstream parts(line);
  for (std::string field; std::getline(parts, field, ',');)
    fields.push_back(field);
  return fields;
}

// Columns X and Y of crack.csv.
std::vector<PathPoint> read_path(const std::string &file)
{
  std::istringstream lines(text_of(file));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = fields_of(line);
  const auto column = [&](const char *name)
  {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end())
      throw support::InputError(file + ": has no column '" + name + "'");
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t X = column("X"), Y = column("Y");
  std::vector<PathPoint> path;
  for (std::size_t number = 2; std::getline(lines, line); ++number)
  {
    const std::vector<std::string> fields = fields_of(line);
    const auto value = [&](std::size_t i)
    {
      double read = 0.;
      const bool is_there = i < fields.size();
      const char *const end = is_there ? fields[i].data() + fields[i].size() : nullptr;
      if (!is_there || std::from_chars(fields[i].data(), end, read).ptr != end || !std::isfinite(read))
        throw support::InputError(file + ":" + std::to_string(number) + ": damaged: a number is missing");
      return read;
    };
    path.push_back({value(X), value(Y)});
    if (path.size() > 1 && path.back().X < path[path.size() - 2].X)
      throw support::InputError(file + ":" + std::to_string(number) + ": damaged: X decreases");
  }
  return path;
}

CrackRun read_run(const std::string &directory)
{
  CrackRun run;
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  parameters.read_file(directory + "/case.prm");
  parameters.finish();
  for (const auto &[key, value] : parameters.values())
  {
    run.entries[key] = value;
    run.units[key] = parameters.unit(key);
  }
  run.spacing = input.spacing;
  const std::optional<output::MeasuredCrack> measured = output::read_measured_crack(directory, input.spacing);
  if (!measured)
    throw support::InputError(
      directory + ": its crack was not measured; crack.json or run.json is damaged, or the run " + "has not ended");
  run.crack = *measured;
  run.path = read_path(directory + "/crack.csv");
  // Cracks of the lattice do not name their side.
  const auto crack = nlohmann::json::parse(text_of(directory + "/crack.json"), nullptr, false);
  run.side = crack.is_object() ? crack.value("side", "lattice") : "lattice";
  return run;
}

std::optional<double> value_in(const output::Values &values, const std::string &name)
{
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional<double>(found->second);
}

bool is_uncertainty(const std::string &name)
{
  const std::string end = "_uncertainty";
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// Y of a path at an X that it covers. Of several points at one X the first counts.
double height_at(const std::vector<PathPoint> &path, double X)
{
  const auto after =
    std::lower_bound(path.begin(), path.end(), X, [](const PathPoint &point, double x) { return point.X < x; });
  if (after->X == X || after == path.begin())
    return after->Y;
  const PathPoint &a = *(after - 1), &b = *after;
  return a.Y + (b.Y - a.Y) * (X - a.X) / (b.X - a.X);
}

} // namespace

std::optional<double> QuantityPair::difference() const
{
  return first && second ? std::optional<double>(*second - *first) : std::nullopt;
}

std::optional<double> QuantityPair::normalized_difference() const
{
  if (!difference() || !first_uncertainty || !second_uncertainty)
    return {};
  const double combined = std::hypot(*first_uncertainty, *second_uncertainty);
  return combined > 0. ? std::optional<double>(*difference() / combined) : std::nullopt;
}

std::optional<PathDistance> path_distance(const std::vector<PathPoint> &first, const std::vector<PathPoint> &second)
{
  if (first.empty() || second.empty())
    return {};
  PathDistance distance{};
  distance.X_begin = std::max(first.front().X, second.front().X);
  distance.X_end = std::min(first.back().X, second.back().X);
  if (!(distance.X_end > distance.X_begin))
    return {};
  std::vector<double> positions{distance.X_begin, distance.X_end};
  for (const std::vector<PathPoint> *path : {&first, &second})
    for (const PathPoint &point : *path)
      if (point.X > distance.X_begin && point.X < distance.X_end)
        positions.push_back(point.X);
  std::sort(positions.begin(), positions.end());
  double integral = 0., previous = 0.;
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    const double apart = height_at(second, positions[i]) - height_at(first, positions[i]);
    if (i == 0 || std::abs(apart) > distance.largest)
    {
      distance.largest = std::abs(apart);
      distance.largest_X = positions[i];
    }
    if (i > 0) // the square of a linear function, integrated
      integral += (positions[i] - positions[i - 1]) * (apart * apart + apart * previous + previous * previous) / 3.;
    previous = apart;
  }
  distance.rms = std::sqrt(integral / (distance.X_end - distance.X_begin));
  return distance;
}

bool holds_crack(const std::string &directory)
{
  std::error_code none;
  return std::filesystem::is_regular_file(std::filesystem::path(directory) / "crack.json", none);
}

RunComparison compare_runs(const std::string &first, const std::string &second)
{
  const CrackRun one = read_run(first), other = read_run(second);
  RunComparison comparison;
  comparison.first = first;
  comparison.second = second;
  comparison.first_side = one.side;
  comparison.second_side = other.side;
  comparison.first_problem = one.crack.problem;
  comparison.second_problem = other.crack.problem;
  comparison.first_pattern = one.crack.pattern;
  comparison.second_pattern = other.crack.pattern;
  comparison.spacing = one.spacing;
  for (const output::CrackQuantity &quantity : output::crack_quantities())
  {
    if (is_uncertainty(quantity.name))
      continue;
    const auto of = [&](const CrackRun &run, const std::string &suffix)
    { return value_in(run.crack.values, quantity.name + suffix); };
    const QuantityPair pair{quantity.name,           quantity.unit, of(one, ""),
                            of(one, "_uncertainty"), of(other, ""), of(other, "_uncertainty")};
    if (pair.first || pair.second)
      comparison.quantities.push_back(pair);
  }
  for (const auto &[key, value] : one.entries)
    if (other.entries.at(key) != value)
      comparison.entries.push_back({key, one.units.at(key), value, other.entries.at(key)});
  comparison.paths = path_distance(one.path, other.path);
  return comparison;
}

} // namespace latcon::commands
