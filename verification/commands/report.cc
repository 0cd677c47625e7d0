#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include <deal.II/base/mpi.h>

#include "support/child_process.h"
#include "verification/commands/command.h"
#include "verification/input/data_folder.h"

namespace latcon::commands
{

namespace
{

// The environment of the user but for what would change the report: python and matplotlib have their own defaults.
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

// Runs a script of the folder report/ on an output directory. @return its exit status
int run_script(const std::string &script, const std::string &directory, const std::string &page, bool quiet)
{
  // Debian's interpreter, the one that sees the packages the script needs, and no packages of the user.
  const std::string python = "/usr/bin/python3";
  std::vector<std::string> command{python, "-s", input::data_folder() + "/report/" + script, directory};
  if (quiet)
    command.emplace_back("--quiet");
  const int status = support::wait_for_child(support::start_child({command, environment_of_scripts(), ""}));
  if (status == support::not_started)
    throw support::OutputError(directory + "/" + page, "cannot start " + python);
  if (status > 128)
    throw support::OutputError(directory + "/" + page, "the report script was killed");
  for (const support::ExitCode known : {support::ExitCode::done, support::ExitCode::bad_input,
                                        support::ExitCode::claim_failed, support::ExitCode::output_failed})
    if (status == static_cast<int>(known))
      return status;
  throw support::OutputError(directory + "/" + page, "the report script failed");
}

} // namespace

support::ExitCode report(const input::Options &options, const std::string &directory)
{
  if (!std::filesystem::is_directory(directory))
    throw support::InputError(directory + " is not a directory");
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    return support::ExitCode::done;
  const auto lock = lock_directory(directory);
  return draw_report(directory, options.quiet);
}

support::ExitCode draw_report(const std::string &directory, bool quiet)
{
  // The script uses the exit codes of this program.
  return static_cast<support::ExitCode>(run_script("report.py", directory, "report.html", quiet));
}

void study_page(const std::string &directory)
{
  if (run_script("study.py", directory, "study.html", true) != 0)
    throw support::OutputError(directory + "/study.html", "the report script failed");
}

} // namespace latcon::commands
