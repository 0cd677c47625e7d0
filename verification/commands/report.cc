#include <cstdlib>
#include <filesystem>

#include <spawn.h>
#include <sys/wait.h>

#include <deal.II/base/mpi.h>

#include "verification/commands/command.h"
#include "verification/data_folder.h"

extern char **environ;

namespace verification
{

namespace
{

// Runs a script of the folder report/ on an output directory. @return its exit status
int run_script(const std::string &script, const std::string &directory, const std::string &page, bool quiet)
{
  // Debian's interpreter, the one that sees the packages the script needs.
  std::string python = "/usr/bin/python3";
  std::string path = data_folder() + "/report/" + script;
  std::string folder = directory;
  // cppcheck-suppress variableScope ; the arguments hold its address until the script is started
  std::string quiet_option = "--quiet";
  std::vector<char *> arguments{python.data(), path.data(), folder.data()};
  if (quiet)
    arguments.push_back(quiet_option.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawn(&child, python.c_str(), nullptr, nullptr, arguments.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child)
    throw OutputError(directory + "/" + page, "cannot start " + python);
  if (!WIFEXITED(status))
    throw OutputError(directory + "/" + page, "the report script was killed");
  return WEXITSTATUS(status);
}

} // namespace

ExitCode report(const Options &options, const std::string &directory)
{
  if (!std::filesystem::is_directory(directory))
    throw InputError(directory + " is not a directory");
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    return ExitCode::done;
  const auto lock = lock_directory(directory);
  return draw_report(directory, options.quiet);
}

ExitCode draw_report(const std::string &directory, bool quiet)
{
  // The script uses the exit codes of this program.
  return static_cast<ExitCode>(run_script("report.py", directory, "report.html", quiet));
}

void study_page(const std::string &directory)
{
  if (run_script("study.py", directory, "study.html", true) != 0)
    throw OutputError(directory + "/study.html", "the report script failed");
}

} // namespace verification
