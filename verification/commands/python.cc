// Commands above one simulation are Python (python/latcon): this program replaces itself by the interpreter.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <vector>

#include <mpi.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "support/child_process.h"
#include "support/errors.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/python.h"
#include "verification/commands/signals.h"
#include "verification/input/files.h"

namespace latcon::commands
{
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string package_folder()
{
  const fs::path data = input::data_folder();
  for (const fs::path &folder : {data / "python", data.parent_path() / "python"})
    if (fs::exists(folder / "latcon" / "study"))
      return folder;
  throw support::Error(support::ExitCode::output_failed,
                       (data / "python").string() + " is missing: a copy of the program needs share/latcon beside its "
                                                    "bin, a symbolic link to the program does not");
}

std::vector<std::string> environment_of_python(const std::string &package)
{
  std::vector<std::string> kept{"PYTHONPATH=" + package};
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("PYTHON", 0) != 0 && text.rfind("MPLBACKEND=", 0) != 0)
      kept.push_back(text);
  }
  return kept;
}

std::string python_interpreter()
{
  // Debian's interpreter, which finds the packages that the scripts need.
  const char *const chosen = std::getenv("LATCON_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

support::ExitCode continue_in_python(const input::Options &options, const std::string &command,
                                     const std::vector<std::string> &names, Json chosen)
{
  if (command == "compare" && !support::is_root_rank())
    return support::ExitCode::done; // the first rank does all the work
  if (support::n_ranks() > 1 && command != "compare")
    throw support::InputError("`latcon " + command + "` is one process; run it without mpirun");
  chosen.update({{"arguments", options.arguments},
                 {"overrides", options.overrides},
                 {"threads", options.threads},
                 {"quick", options.quick},
                 {"quiet", options.quiet},
                 {"verbose", options.verbose},
                 {"dry_run", options.dry_run},
                 {"yes", options.yes},
                 {"skip_verification", options.skip_verification},
                 {"no_report", options.no_report},
                 {"resume", options.resume}});
  const std::string python = python_interpreter();
  if (access(python.c_str(), X_OK) != 0)
    throw support::Error(support::ExitCode::output_failed,
                         "cannot start " + python + "; install python3, or set LATCON_PYTHON to its path");
  const std::string package = package_folder();
  std::vector<std::string> words{python,
                                 "-sP",
                                 "-m",
                                 "latcon",
                                 "--parsed",
                                 command,
                                 options.output_dir,
                                 fs::read_symlink("/proc/self/exe"),
                                 input::data_folder()};
  words.insert(words.end(), names.begin(), names.end()); // words of their own: paths need not be UTF-8
  words.push_back(chosen.dump(-1, ' ', false, Json::error_handler_t::replace));
  std::vector<std::string> environment = environment_of_python(package);
  const std::vector<char *> arguments = support::pointers(words), variables = support::pointers(environment);
  std::cout << std::flush;
  disregard_signals();
  MPI_Finalize();
  sigset_t all; // until Python handles them
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, nullptr);
  execve(python.c_str(), arguments.data(), variables.data());
  std::cerr << "latcon: cannot start " << python << std::endl;
  std::_Exit(static_cast<int>(support::ExitCode::output_failed));
}

} // namespace latcon::commands
