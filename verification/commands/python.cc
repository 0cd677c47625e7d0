// Commands above one simulation are Python (python/latcon): this program replaces itself by the interpreter.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <mpi.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/errors.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/signals.h"
#include "verification/input/files.h"
#include "verification/output/progress.h"

namespace latcon::commands
{
namespace
{

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Returns the folder that contains the Python package: in the data folder, or in the source tree. @throws OutputError
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

// Returns the environment of the user without variables that would change the interpreter or matplotlib, with the path
// of the package and one thread of BLAS: each process draws or judges on one core.
std::vector<std::string> environment_of_python(const std::string &package)
{
  std::vector<std::string> kept{"PYTHONPATH=" + package, "OPENBLAS_NUM_THREADS=1"};
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("PYTHON", 0) != 0 && text.rfind("MPLBACKEND=", 0) != 0 &&
        text.rfind("OPENBLAS_NUM_THREADS=", 0) != 0)
      kept.push_back(text);
  }
  return kept;
}

// Returns the path of the Python interpreter: the environment variable LATCON_PYTHON, or that of Debian.
std::string python_interpreter()
{
  // Debian's interpreter, which finds the packages that the scripts need.
  const char *const chosen = std::getenv("LATCON_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

// Pointers to words that live on, followed by a null pointer, as execve() wants them.
std::vector<char *> pointers(std::vector<std::string> &words)
{
  std::vector<char *> list(words.size() + 1);
  std::transform(words.begin(), words.end(), list.begin(), [](std::string &word) { return word.data(); });
  return list;
}

constexpr int not_started = 127; // exit status of a child

// Starts a program without standard input. The child gets SIGTERM if this process dies. It ignores SIGINT: Ctrl-C in a
// terminal reaches both processes, and this process handles it. Throws OutputError if the process cannot be started.
pid_t start_child(std::vector<std::string> command, std::vector<std::string> variables)
{
  const std::vector<char *> arguments = pointers(command), environment = pointers(variables);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0)
  {
    // Between fork and exec, only async-signal-safe functions may be called.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
      _exit(not_started);
    signal(SIGINT, SIG_IGN);
    dup2(nothing, STDIN_FILENO);
    execve(arguments.front(), arguments.data(), environment.data());
    _exit(not_started);
  }
  const int error = errno;
  close(nothing);
  if (child < 0)
    throw support::Error(support::ExitCode::output_failed,
                         command.front() + ": cannot start a process: " + std::generic_category().message(error));
  return child;
}

// Waits for a child, with a progress line if it is wanted. @return its exit status, 128 + the signal that killed it, or
// not_started
int wait_for_child(pid_t child, const std::string &what, bool shows_progress)
{
  using Clock = std::chrono::steady_clock;
  output::Progress progress(shows_progress);
  const Clock::time_point start = Clock::now();
  while (true)
  {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended > 0)
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (ended < 0 && errno != EINTR)
      return not_started;
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

} // namespace

support::ExitCode continue_in_python(const input::Options &options, const std::string &command,
                                     const std::vector<std::string> &names, Json chosen)
{
  if (support::n_ranks() > 1 && (command == "study" || command == "batch"))
    throw support::InputError("`latcon " + command + "` is one process; run it without mpirun");
  if (!support::is_root_rank())
    return support::ExitCode::done; // the first rank does all the work
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
  const std::vector<char *> arguments = pointers(words), variables = pointers(environment);
  std::cout << std::flush;
  disregard_signals();
  MPI_Finalize();
  pass_signals_on();
  execve(python.c_str(), arguments.data(), variables.data());
  std::cerr << "latcon: cannot start " << python << std::endl;
  std::_Exit(static_cast<int>(support::ExitCode::output_failed));
}

support::ExitCode draw_report(const std::string &directory, const bool shows_progress)
{
  const std::string python = python_interpreter(), package = package_folder(), page = directory + "/report.html";
  const pid_t child =
    start_child({python, "-sP", package + "/latcon/report/__main__.py", "report", directory, "--quiet"},
                environment_of_python(package));
  const int status = wait_for_child(child, "drawing report.html", shows_progress);
  if (status == not_started)
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

} // namespace latcon::commands
