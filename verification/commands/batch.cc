#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <sstream>

#include <unistd.h>

#include "support/child_process.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/requested_study.h"
#include "verification/input/case_text.h"
#include "verification/output/output_file.h"
#include "verification/study/study_output.h"

namespace latcon::commands
{
namespace
{

namespace fs = std::filesystem;

constexpr std::size_t max_default_tasks = 1000; // MaxArraySize of Slurm is 1001 unless configured

// A word for a POSIX shell.
std::string quoted(const std::string &word)
{
  static const std::regex plain("[A-Za-z0-9_./:=+,@%-]+");
  if (std::regex_match(word, plain))
    return word;
  return "'" + std::regex_replace(word, std::regex("'"), "'\\''") + "'";
}

// `latcon study` with the choices of the user, from any folder.
// @param given name or file of the study, as given by the user
std::string study_command(const input::Options &options, const RequestedStudy &requested, const std::string &given)
{
  const std::string study = requested.is_sweep() ? requested.file : given;
  std::string command = quoted(fs::read_symlink("/proc/self/exe").string()) + " study " +
                        quoted(fs::exists(study) ? fs::absolute(study).lexically_normal().string() : study);
  for (const std::string &setting : requested.settings)
    command += " --set " + quoted(setting);
  if (options.quick)
    command += " --quick";
  if (options.skip_verification)
    command += " --skip-verification";
  if (options.yes)
    command += " --yes";
  return command + " --output-dir " + quoted(fs::absolute(options.output_dir).lexically_normal().string());
}

std::string directives(const BatchOptions &chosen, const std::string &name, const std::string &log)
{
  std::ostringstream text;
  text << "#!/bin/bash\n#SBATCH --job-name=" << name << "\n#SBATCH --ntasks=1\n#SBATCH --time=" << chosen.time
       << "\n#SBATCH --output=" << log << "\n#SBATCH --open-mode=append\n";
  if (!chosen.partition.empty())
    text << "#SBATCH --partition=" << chosen.partition << "\n";
  return text.str();
}

std::string array_script(const std::string &command, const BatchOptions &chosen, std::size_t n_tasks,
                         const std::string &folder)
{
  std::ostringstream text;
  text << directives(chosen, "latcon-runs", folder + "/runs-%a.log") << "#SBATCH --array=1-" << n_tasks
       << "\n#SBATCH --cpus-per-task=" << chosen.cpus_per_task << "\n#SBATCH --requeue\n#SBATCH --signal=B:USR1@120\n"
       << R"(
# Two minutes before the time limit the runs write checkpoints, and the task is requeued to continue from them.
requeue=no
trap 'requeue=yes; kill -TERM "$runs"' USR1
trap 'kill -TERM "$runs"' TERM
)" << command
       << " --shard \"$SLURM_ARRAY_TASK_ID/" << n_tasks << "\" --threads " << chosen.cpus_per_task << " --quiet &\n"
       << R"(runs=$!
# A signal ends `wait` before the program ends.
wait "$runs"
while kill -0 "$runs" 2>/dev/null; do
  wait "$runs"
done
wait "$runs"
code=$?
if [ "$requeue" = yes ] && [ "$code" -eq 130 ]; then
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
)";
  return text.str();
}

// Submits a script. @return the number of the job
std::string submit(const std::vector<std::string> &arguments, const std::string &log)
{
  std::vector<std::string> command{"/usr/bin/env", "sbatch", "--parsable"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables;
  for (char **variable = environ; *variable != nullptr; ++variable)
    variables.emplace_back(*variable);
  const int status = support::wait_for_child(support::start_child({command, variables, log}));
  std::ifstream file(log);
  const std::string printed = input::trimmed({std::istreambuf_iterator<char>(file), {}});
  if (status == support::not_started)
    throw support::InputError("--submit: there is no sbatch on this machine; copy the scripts to one with Slurm, or "
                              "submit them there");
  if (status != 0)
    throw support::InputError("--submit: sbatch ended with " + std::to_string(status) + ": " +
                              input::printable(printed, 300));
  return printed.substr(printed.find_last_of('\n') + 1, std::string::npos); // warnings come first
}

// Returns a time limit of Slurm: minutes[:seconds], hours:minutes:seconds, days-hours[:minutes[:seconds]].
double seconds_of(const std::string &limit)
{
  const std::size_t days_end = limit.find('-');
  const bool has_days = days_end != std::string::npos;
  std::istringstream text(has_days ? limit.substr(days_end + 1) : limit);
  std::vector<double> parts;
  for (std::string part; std::getline(text, part, ':');)
    parts.push_back(std::strtod(part.c_str(), nullptr));
  if (!has_days && parts.size() < 3)
    parts.insert(parts.begin(), 0.);
  parts.resize(3, 0.);
  return ((has_days ? 24. * std::strtod(limit.c_str(), nullptr) : 0.) + parts[0]) * 3600. + parts[1] * 60. + parts[2];
}

} // namespace

support::ExitCode write_batch(const input::Options &options, const BatchOptions &chosen)
{
  if (support::n_ranks() > 1)
    throw support::InputError("`latcon batch` writes scripts for one cluster; run it without mpirun");
  static const std::regex time("([0-9]+-)?[0-9]+(:[0-9]{2}){0,2}"), name("[A-Za-z0-9_.,-]*");
  if (!std::regex_match(chosen.time, time))
    throw support::InputError("--time '" + input::printable(chosen.time) +
                              "': expected [days-]hours:minutes:seconds, for example 1-00:00:00");
  if (seconds_of(chosen.time) < 300.)
    throw support::InputError("--time '" + chosen.time +
                              "': a run writes its checkpoint two minutes before the limit; give at least 5 minutes");
  if (!std::regex_match(chosen.partition, name))
    throw support::InputError("--partition '" + input::printable(chosen.partition) + "': expected a name");
  const RequestedStudy requested = read_requested_study(options, chosen.study, chosen.sweep);
  const study::Study &study = requested.study;
  require_no_refinement(study);
  const std::vector<study::PlannedRun> plan =
    study::plan_runs(study, requested.base, requested.settings, verification_of(options));
  const std::size_t n_tasks = std::min(plan.size(), chosen.tasks > 0 ? chosen.tasks : max_default_tasks);
  if (options.dry_run)
  {
    if (!options.quiet)
      study::print_plan(std::cout, study, plan, n_tasks * chosen.cpus_per_task);
    return support::ExitCode::done;
  }

  const fs::path folder = fs::absolute(options.output_dir).lexically_normal() / "batch";
  if (!std::regex_match(folder.string(), std::regex("[^\\s%\\\\'\"]+")))
    throw support::InputError("--output-dir '" + input::printable(folder.string()) +
                              "': sbatch does not support folders with blanks, quotes, % or \\ for its log files");
  require_folder_of(study, options.output_dir);
  fs::create_directories(folder);
  if (requested.is_sweep())
  {
    const auto lock = lock_directory(options.output_dir);
    write_sweep(requested);
  }
  const std::string command = study_command(options, requested, chosen.study);
  const std::string runs = (folder / "runs.sh").string(), collect = (folder / "collect.sh").string();
  output::write_file(runs, array_script(command, chosen, n_tasks, folder.string()));
  output::write_file(collect, directives(chosen, "latcon-collect", (folder / "collect.log").string()) + "\nexec " +
                                command + " --collect\n");
  if (!chosen.submit)
  {
    if (!options.quiet)
      std::cout << plan.size() << " runs in " << n_tasks << " tasks. To submit them:\n  runs=$(sbatch --parsable "
                << quoted(runs) << ")\n  sbatch --dependency=afterany:$runs " << quoted(collect) << std::endl;
    return support::ExitCode::done;
  }
  const std::string log = (folder / "sbatch.log").string();
  const std::string array = submit({runs}, log);
  if (!options.quiet)
    std::cout << plan.size() << " runs in " << n_tasks << " tasks: job " << array << std::endl;
  const std::string judge = submit({"--dependency=afterany:" + array, collect}, log);
  if (!options.quiet)
    std::cout << "then the verdict: job " << judge << std::endl;
  return support::ExitCode::done;
}

} // namespace latcon::commands
