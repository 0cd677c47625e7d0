#include <chrono>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <unistd.h>

#include "support/child_process.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/python.h"
#include "verification/input/data_folder.h"
#include "verification/output/progress.h"

namespace latcon::commands
{

namespace
{

// The environment of the user without variables that would change the report: those of python and matplotlib.
std::vector<std::string> environment_of_scripts()
{
  std::vector<std::string> kept;
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("PYTHON", 0) != 0 && text.rfind("MPLBACKEND=", 0) != 0)
      kept.push_back(text);
  }
  return kept;
}

// The interpreter cannot be started.
struct NoPython : support::OutputError
{
  using support::OutputError::OutputError;
};

// Waits for a child with a progress line. @return its exit status
int wait_with_progress(pid_t child, const std::string &what)
{
  using Clock = std::chrono::steady_clock;
  output::Progress progress(true);
  const Clock::time_point start = Clock::now();
  while (true)
  {
    const int status = support::poll_child(child);
    if (status != -1)
      return status;
    if (progress.due())
      progress.show(what + ", " +
                      std::to_string(std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start).count()) +
                      " s so far",
                    0.);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

// Exit status of a script that has named the missing Debian packages: PACKAGES_MISSING of own_settings.py.
constexpr int packages_missing = 69;

// Runs a script of the folder report/ on an output directory. @return its exit status
// @param options of the script @param page name for messages
int run_script(const std::string &script, const std::string &directory, const std::vector<std::string> &options,
               const std::string &page, bool shows_progress = false)
{
  const std::string python = python_interpreter(); // without packages of the user
  const std::string file = input::data_folder() + "/report/" + script;
  if (!std::filesystem::exists(file))
    throw NoPython(directory + "/" + page, file +
                                             " is missing: a copy of the program needs share/latcon beside its bin, "
                                             "a symbolic link to the program does not");
  std::vector<std::string> command{python, "-s", file, directory};
  command.insert(command.end(), options.begin(), options.end());
  const pid_t child = support::start_child({command, environment_of_scripts()});
  const int status = shows_progress ? wait_with_progress(child, "drawing " + page) : support::wait_for_child(child);
  if (status == support::not_started)
    throw NoPython(directory + "/" + page, "cannot start " + python);
  if (status > 128)
    throw support::OutputError(directory + "/" + page, "the report script was killed");
  for (const support::ExitCode known : {support::ExitCode::done, support::ExitCode::bad_input,
                                        support::ExitCode::claim_failed, support::ExitCode::output_failed})
    if (status == static_cast<int>(known))
      return status;
  if (status == packages_missing)
    return status;
  throw support::OutputError(directory + "/" + page, "the report script failed");
}

support::ExitCode run_report(const std::string &directory, const std::vector<std::string> &options, bool shows_progress)
{
  const int status = run_script("report.py", directory, options, "report.html", shows_progress);
  if (status == packages_missing)
  {
    std::cerr << "latcon: no report; every other file is complete. With these packages, draw it by: latcon report "
              << directory << std::endl;
    return support::ExitCode::output_failed;
  }
  // The script uses the exit codes of this program.
  return static_cast<support::ExitCode>(status);
}

} // namespace

support::ExitCode report(const input::Options &options, const ReportOptions &chosen)
{
  if (!std::filesystem::is_directory(chosen.directory))
    throw support::InputError(chosen.directory + " is not a directory");
  if (!support::is_root_rank())
    return support::ExitCode::done;
  std::vector<std::string> words;
  if (options.quiet)
    words.emplace_back("--quiet");
  if (chosen.animation)
    words.emplace_back("--animation");
  if (!options.output_dir.empty())
  {
    std::error_code error;
    std::filesystem::create_directories(options.output_dir, error);
    if (error)
      throw support::OutputError(options.output_dir, error.message());
    words.insert(words.end(), {"--output-dir", options.output_dir});
  }
  const auto lock = lock_directory(options.output_dir.empty() ? chosen.directory : options.output_dir);
  return run_report(chosen.directory, words, false);
}

support::ExitCode draw_report(const std::string &directory, bool quiet, bool shows_progress)
{
  return run_report(directory, quiet ? std::vector<std::string>{"--quiet"} : std::vector<std::string>{},
                    shows_progress);
}

bool draw_page(const Page &page, const std::string &directory)
{
  // Nodes of a cluster may have no Python, or no packages; all results are written.
  std::string problem;
  try
  {
    const int status = run_script(page.script, directory, {"--quiet"}, page.file);
    if (status == packages_missing)
      problem = "cannot draw " + directory + "/" + page.file + " without these packages";
    else if (status != 0)
      throw support::OutputError(directory + "/" + page.file, "the report script failed");
  }
  catch (const NoPython &error)
  {
    problem = error.what();
  }
  if (!problem.empty())
    std::cerr << "latcon: " << problem << "; every other file is complete. To draw the page, repeat the command"
              << page.repeat << " on a machine with Python and the packages of the report" << std::endl;
  return problem.empty();
}

} // namespace latcon::commands
