#include <cstdlib>
#include <filesystem>

#include <spawn.h>
#include <sys/wait.h>

#include <deal.II/base/mpi.h>

#include "verification/commands/command.h"

extern char **environ;

namespace verification
{

ExitCode report(const Options &options, const std::string &directory)
{
  if (!std::filesystem::is_directory(directory))
    throw InputError(directory + " is not a directory");
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    return ExitCode::done;

  // Debian's interpreter, the one that sees the packages the script needs.
  std::string python = "/usr/bin/python3";
  std::string script = std::string(LATCON_DATA_DIR) + "/report/report.py";
  std::string folder = directory;
  std::string quiet = "--quiet";
  std::vector<char *> arguments{python.data(), script.data(), folder.data()};
  if (options.quiet)
    arguments.push_back(quiet.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawn(&child, python.c_str(), nullptr, nullptr, arguments.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child)
    throw OutputError(directory + "/report.html", "cannot start " + python);
  if (!WIFEXITED(status))
    throw OutputError(directory + "/report.html", "the report script was killed");
  // The script uses the exit codes of this program.
  return static_cast<ExitCode>(WEXITSTATUS(status));
}

} // namespace verification
