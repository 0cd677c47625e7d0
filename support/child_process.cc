#include "support/child_process.h"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/errors.h"

namespace latcon::support
{
namespace
{

int status_of(pid_t child, int options)
{
  int status = 0;
  const pid_t ended = waitpid(child, &status, options);
  if (ended == 0 || (ended < 0 && errno == EINTR))
    return -1;
  if (ended < 0)
    return not_started;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

std::vector<char *> pointers(std::vector<std::string> &words)
{
  std::vector<char *> list;
  for (std::string &word : words)
    list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

pid_t start_child(const ChildProgram &program)
{
  std::vector<std::string> command = program.command, variables = program.environment;
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
    throw OutputError(program.command.front(), "cannot start a process: " + std::generic_category().message(error));
  return child;
}

int wait_for_child(pid_t child)
{
  int status = -1;
  while (status < 0)
    status = status_of(child, 0);
  return status;
}

int poll_child(pid_t child)
{
  return status_of(child, WNOHANG);
}

} // namespace latcon::support
