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

std::vector<char *> pointers(std::vector<std::string> &words)
{
  std::vector<char *> list;
  for (std::string &word : words)
    list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

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

pid_t start_child(const ChildProgram &program)
{
  std::vector<std::string> command = program.command, variables = program.environment;
  const std::vector<char *> arguments = pointers(command), environment = pointers(variables);
  int log = -1;
  if (!program.log.empty())
  {
    log = open(program.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (log < 0)
      throw OutputError(program.log, std::generic_category().message(errno));
  }
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
    if (log >= 0)
    {
      dup2(log, STDOUT_FILENO);
      dup2(log, STDERR_FILENO);
    }
    execve(arguments.front(), arguments.data(), environment.data());
    _exit(not_started);
  }
  const int error = errno;
  if (log >= 0)
    close(log);
  close(nothing);
  if (child < 0)
    throw OutputError(program.log.empty() ? program.command.front() : program.log,
                      "cannot start a process: " + std::generic_category().message(error));
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
