// The program for tests. With arguments it is latcon. Without, it runs latcon once for each line on standard input, in
// a child made by fork: what takes half a second to start, MPI and the module with the finite elements, starts once.
//
// A line is `LIMIT OUTPUT FOLDER ARGUMENT...`: seconds, the folder of the files stdout and stderr of the child, the
// folder to work in, and the arguments of latcon without its name, each word in hexadecimal. The answer is a line:
// `exit CODE`, `signal NUMBER`, or `limit` if the child was killed after LIMIT seconds.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/mpi_session.h"
#include "verification/commands/command_line.h"
#include "verification/elements/elements.h"
#define main latcon_main
#include "verification/main.cc"
#undef main

using namespace latcon;

namespace
{

std::string decoded(const std::string &hexadecimal)
{
  std::string text;
  for (std::size_t i = 0; i + 1 < hexadecimal.size(); i += 2)
    text += static_cast<char>(std::stoi(hexadecimal.substr(i, 2), nullptr, 16));
  return text;
}

void redirect(int descriptor, const std::string &path)
{
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2(file, descriptor) < 0)
    _exit(99);
  close(file);
}

[[noreturn]] void run_child(const std::string &output, const std::string &folder, std::vector<std::string> arguments)
{
  redirect(STDOUT_FILENO, output + "/stdout");
  redirect(STDERR_FILENO, output + "/stderr");
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  if (chdir(folder.c_str()) != 0)
    _exit(99);
  arguments.insert(arguments.begin(), "latcon");
  std::vector<char *> argv;
  for (std::string &argument : arguments)
    argv.push_back(argument.data());
  argv.push_back(nullptr);
  // A fork cannot end MPI, as they do before they become Python.
  const std::set<std::string> python{"study", "batch", "compare", "report", "entries", "help", "init"};
  if (arguments.size() > 1 && python.count(arguments[1]) > 0)
  {
    execv("/proc/self/exe", argv.data());
    _exit(99);
  }
  const auto code = commands::run_program(static_cast<int>(arguments.size()), argv.data());
  std::cout.flush();
  std::fflush(nullptr);
  _exit(static_cast<int>(code));
}

bool needs_finite_elements(const std::vector<std::string> &arguments)
{
  const auto has = [&](const char *word)
  { return std::find(arguments.begin(), arguments.end(), word) != arguments.end(); };
  return has("continuum") || has("verify") || (has("fracture") && !has("--skip-verification"));
}

std::string outcome(const pid_t child, const double limit)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0)
  {
    if (std::chrono::duration<double>(Clock::now() - start).count() > limit)
    {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return "limit";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (WIFSIGNALED(status))
    return "signal " + std::to_string(WTERMSIG(status));
  return "exit " + std::to_string(WEXITSTATUS(status));
}

void serve()
{
  std::string line;
  while (std::getline(std::cin, line))
  {
    std::istringstream words(line);
    double limit = 0.;
    std::string output, folder, word;
    words >> limit >> output >> folder;
    std::vector<std::string> arguments;
    while (words >> word)
      arguments.push_back(decoded(word));
    if (needs_finite_elements(arguments))
      static_cast<void>(elements::elements()); // loaded before the fork, the module serves all later children
    std::cout.flush();
    const pid_t child = fork();
    if (child < 0)
      throw std::runtime_error("cannot fork");
    if (child == 0)
      run_child(decoded(output), decoded(folder), arguments);
    std::cout << outcome(child, limit) << std::endl;
  }
}

} // namespace

int main(int argc, char **argv)
{
  if (argc > 1)
    return latcon_main(argc, argv);
  // Threads do not survive a fork.
  setenv("OMP_NUM_THREADS", "1", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  {
    const support::MpiSession mpi;
    serve();
  }
  _exit(0); // what the module with the finite elements keeps would be released after it
}
