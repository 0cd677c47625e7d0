#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "verification/commands/command.h"
#include "verification/compare/difference_writer.h"
#include "verification/input/units.h"
#include "verification/output/output_file.h"

namespace latcon::commands
{
namespace
{

// A time [s], or load factor [-], of the command line.
std::optional<double> time_option(const std::string &name, const std::string &text)
{
  if (text.empty())
    return {};
  const input::ParsedNumber quantity = input::read_quantity(text, "s");
  if (!quantity.wrong.empty())
    throw support::InputError(name + " " + text + ": " + quantity.wrong);
  return quantity.value;
}

std::map<std::string, double> read_tolerances(const std::vector<std::string> &texts)
{
  std::string names;
  for (const compare::CommonField &field : compare::common_fields)
    names += (names.empty() ? "" : ", ") + std::string(field.name);
  std::map<std::string, double> tolerances;
  std::vector<std::string> problems;
  for (const std::string &text : texts)
  {
    const std::size_t equals = text.find('=');
    const std::string field = text.substr(0, equals);
    bool known = false;
    for (const compare::CommonField &common : compare::common_fields)
      known = known || field == common.name;
    if (equals == std::string::npos || !known)
    {
      problems.push_back("--tolerance " + text + ": FIELD=VALUE is wanted, FIELD one of " + names);
      continue;
    }
    const input::ParsedNumber quantity = input::read_quantity(text.substr(equals + 1), "1");
    if (!quantity.wrong.empty() || !(quantity.value > 0.))
      problems.push_back("--tolerance " + text + ": " +
                         (quantity.wrong.empty() ? "must be larger than 0" : quantity.wrong));
    tolerances[field] = quantity.value;
  }
  if (!problems.empty())
    throw support::InputError(problems);
  return tolerances;
}

std::vector<compare::Circle> read_circles(const std::vector<std::string> &texts)
{
  std::vector<compare::Circle> circles;
  std::vector<std::string> problems;
  for (const std::string &text : texts)
  {
    const auto wrong = [&](const std::string &why) { problems.push_back("--exclude " + text + ": " + why); };
    std::vector<double> numbers;
    std::istringstream parts(text + ",");
    for (std::string part; std::getline(parts, part, ',');)
    {
      const input::ParsedNumber quantity = input::read_quantity(part, "m");
      if (!quantity.wrong.empty())
        wrong(quantity.wrong);
      numbers.push_back(quantity.value);
    }
    if (numbers.size() != 3)
      wrong("X,Y,R is wanted, three lengths");
    else if (!(numbers[2] > 0.))
      wrong("the radius must be larger than 0");
    else
      circles.push_back({{{numbers[0], numbers[1]}}, numbers[2]});
  }
  if (!problems.empty())
    throw support::InputError(problems);
  return circles;
}

// Refuses an output directory whose results.json and run.json would be replaced by those of the comparison.
void require_own_directory(const std::string &directory, const compare::Frame &frame)
{
  std::error_code ignored;
  const std::filesystem::path folder = frame.file.path.parent_path();
  if (std::filesystem::equivalent(directory, folder.empty() ? "." : folder, ignored))
    throw support::InputError("--output-dir " + directory + " is where " + frame.file.path.filename().string() +
                              " is from, whose run.json and results.json would be lost: give another");
}

// Refuses options for frames, and an output directory whose run.json would be lost. @throws InputError
void require_options_for_cracks(const input::Options &options, const CompareOptions &chosen)
{
  if (!(chosen.time.empty() && chosen.lattice_time.empty() && chosen.continuum_time.empty() &&
        chosen.tolerances.empty() && chosen.excluded.empty()) ||
      chosen.overlap)
    throw support::InputError(
      "--time, --lattice-time, --continuum-time, --tolerance, --overlap and --exclude are for frames, and " +
      chosen.lattice + " and " + chosen.continuum + " are two cracks; to compare frames, give their files");
  for (const std::string &run : {chosen.lattice, chosen.continuum})
    if (std::error_code none; std::filesystem::equivalent(options.output_dir, run, none))
      throw support::InputError("--output-dir " + options.output_dir +
                                " is one of the runs, whose run.json would be lost: give another");
}

bool holds_crack(const std::string &directory)
{
  std::error_code none;
  return std::filesystem::is_regular_file(std::filesystem::path(directory) / "crack.json", none);
}

// Refuses one crack and something else, and explains what can be compared. @throws InputError
void refuse_mixture(const CompareOptions &chosen)
{
  const auto crack = [](const std::string &name) { return name + " holds a crack (crack.json)"; };
  const auto none = [](const std::string &name) { return name + " holds no crack.json"; };
  const bool first = holds_crack(chosen.lattice);
  throw support::InputError((first ? crack(chosen.lattice) + ", " + none(chosen.continuum)
                                   : none(chosen.lattice) + ", " + crack(chosen.continuum)) +
                            "; give two output directories of cracks, or a lattice frame and a continuum frame in this "
                            "order");
}

// Returns whether a name is that of a folder without frames of a side.
bool is_folder_without(const std::string &name, const char *series)
{
  std::error_code none;
  return std::filesystem::is_directory(name, none) &&
         !std::filesystem::exists(std::filesystem::path(name) / series, none);
}

} // namespace

support::ExitCode compare_frames(const input::Options &options, const CompareOptions &chosen)
{
  if (!options.overrides.empty())
    throw support::InputError("latcon compare has no case that --set could change");
  const bool first = holds_crack(chosen.lattice), second = holds_crack(chosen.continuum);
  if (first && second)
  {
    require_options_for_cracks(options, chosen);
    return compare_cracks(options, chosen.lattice, chosen.continuum);
  }
  if ((first && is_folder_without(chosen.continuum, "continuum.pvd")) || second)
    refuse_mixture(chosen);
  if (!chosen.time.empty() && !(chosen.lattice_time.empty() && chosen.continuum_time.empty()))
    throw support::InputError("--time is for both sides: give it, or --lattice-time and --continuum-time");
  const std::map<std::string, double> tolerances = read_tolerances(chosen.tolerances);
  const compare::Scope scope{chosen.overlap, read_circles(chosen.excluded)};
  const auto lattice_time = time_option(chosen.time.empty() ? "--lattice-time" : "--time",
                                        chosen.time.empty() ? chosen.lattice_time : chosen.time);
  const auto continuum_time = time_option(chosen.time.empty() ? "--continuum-time" : "--time",
                                          chosen.time.empty() ? chosen.continuum_time : chosen.time);
  output::Stopwatch stopwatch;
  auto reading = std::make_unique<output::Stopwatch::Phase>(stopwatch, "reading");
  compare::FrameFile lattice_file = compare::find_frame(chosen.lattice, compare::Side::lattice, lattice_time);
  compare::FrameFile continuum_file = compare::find_frame(chosen.continuum, compare::Side::continuum, continuum_time);
  // Only times given for each side by itself may differ.
  if (!chosen.time.empty())
    lattice_file.chosen = continuum_file.chosen = false;
  const compare::LatticeFrame lattice = compare::read_lattice_frame(lattice_file, lattice_time);
  const compare::ContinuumFrame continuum = compare::read_continuum_frame(continuum_file, continuum_time);
  reading.reset();
  compare::require_same_time(lattice, continuum);
  if (!scope.is_overlap)
    compare::require_same_bounds(lattice, continuum);
  require_own_directory(options.output_dir, lattice);
  require_own_directory(options.output_dir, continuum);
  auto comparing = std::make_unique<output::Stopwatch::Phase>(stopwatch, "comparing");
  const compare::Comparison comparison = compare::compare(lattice, continuum, scope, MPI_COMM_WORLD);
  const output::Results results = compare::norms(lattice, continuum, comparison, tolerances);
  comparing.reset();
  if (options.dry_run)
  {
    print_dry_run(options, "# lattice: " + lattice.file.path.string() + ", " + std::to_string(lattice.points.size()) +
                             " sites\n# continuum: " + continuum.file.path.string() + ", " +
                             std::to_string(continuum.cells.size()) + " cells\n");
    return support::ExitCode::done;
  }

  Run run(options);
  for (const auto &[phase, seconds] : stopwatch.times())
    run.info().stopwatch().add(phase, seconds);
  run.info().add("lattice_frame", lattice.file.path.string());
  run.info().add("continuum_frame", continuum.file.path.string());
  if (run.is_root())
  {
    const auto phase = run.info().stopwatch().phase("output");
    compare::write_difference(run.directory(), lattice, continuum, comparison);
  }
  return run.finish(results);
}

} // namespace latcon::commands
