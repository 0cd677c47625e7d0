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
#include "verification/output/progress.h"

namespace latcon::commands
{

namespace
{

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

// Exit status of the script after it has named missing Debian packages: PACKAGES_MISSING of report/__main__.py.
constexpr int packages_missing = 69;

// Draws report.html by python/latcon/report. @return the exit code of the script @param options of the script
support::ExitCode run_report(const std::string &directory, const std::vector<std::string> &options, bool shows_progress)
{
  const std::string python = python_interpreter(), package = package_folder(), page = directory + "/report.html";
  std::vector<std::string> command{python, "-sP", package + "/latcon/report/__main__.py", "report", directory};
  command.insert(command.end(), options.begin(), options.end());
  const pid_t child = support::start_child({command, environment_of_python(package)});
  const int status = shows_progress ? wait_with_progress(child, "drawing report.html") : support::wait_for_child(child);
  if (status == support::not_started)
    throw support::OutputError(page, "cannot start " + python);
  if (status > 128)
    throw support::OutputError(page, "the report script was killed");
  if (status == packages_missing)
  {
    std::cerr << "latcon: no report; every other file is complete. With these packages, draw it by: latcon report "
              << directory << std::endl;
    return support::ExitCode::output_failed;
  }
  // The script uses the exit codes of this program.
  for (const support::ExitCode known : {support::ExitCode::done, support::ExitCode::bad_input,
                                        support::ExitCode::claim_failed, support::ExitCode::output_failed})
    if (status == static_cast<int>(known))
      return known;
  throw support::OutputError(page, "the report script failed");
}

} // namespace

support::ExitCode report(const input::Options &options, const std::string &directory, const bool animation)
{
  if (!std::filesystem::is_directory(directory))
    throw support::InputError(directory + " is not a directory");
  if (!support::is_root_rank())
    return support::ExitCode::done;
  std::vector<std::string> words;
  if (options.quiet)
    words.emplace_back("--quiet");
  if (animation)
    words.emplace_back("--animation");
  if (!options.output_dir.empty())
  {
    std::error_code error;
    std::filesystem::create_directories(options.output_dir, error);
    if (error)
      throw support::OutputError(options.output_dir, error.message());
    words.insert(words.end(), {"--output-dir", options.output_dir});
  }
  const auto lock = lock_directory(options.output_dir.empty() ? directory : options.output_dir);
  return run_report(directory, words, false);
}

support::ExitCode draw_report(const std::string &directory, bool quiet, bool shows_progress)
{
  return run_report(directory, quiet ? std::vector<std::string>{"--quiet"} : std::vector<std::string>{},
                    shows_progress);
}

} // namespace latcon::commands
