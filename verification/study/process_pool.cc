#include "verification/study/process_pool.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/mpi_session.h"
#include "verification/errors.h"

extern char **environ;

namespace verification
{
namespace
{

constexpr std::chrono::milliseconds poll_interval(20);
constexpr std::chrono::seconds patience(60);
constexpr int not_started = 127;

std::vector<char *> environment_of_children()
{
  std::vector<char *> kept;
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("OMPI_", 0) != 0 && text.rfind("PMIX_", 0) != 0 && !latcon::support::is_launcher_variable(text))
      kept.push_back(*variable);
  }
  kept.push_back(nullptr);
  return kept;
}

pid_t start_process(ProcessPool::Job job)
{
  std::vector<char *> arguments;
  for (std::string &word : job.command)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<char *> environment = environment_of_children();
  const int log = open(job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (log < 0)
    throw OutputError(job.log, std::generic_category().message(errno));
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0)
  {
    // Between fork and exec only what is safe in a signal handler.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
      _exit(not_started);
    dup2(nothing, STDIN_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    execve(arguments.front(), arguments.data(), environment.data());
    _exit(not_started);
  }
  close(log);
  close(nothing);
  if (child < 0)
    throw OutputError(job.log, "cannot start a process: " + std::generic_category().message(errno));
  return child;
}

struct Child
{
  std::size_t job;
  pid_t process;
};

// The status of a child that has ended; -1 of one that has not.
int status_of(const Child &child)
{
  int status = 0;
  const pid_t ended = waitpid(child.process, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR))
    return -1;
  if (ended < 0)
    return not_started;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Ends what runs, whichever way the pool is left.
class Children : public std::vector<Child>
{
public:
  Children() = default;
  Children(const Children &) = delete;
  Children &operator=(const Children &) = delete;
  ~Children()
  {
    tell(SIGTERM);
    const auto last_moment = std::chrono::steady_clock::now() + patience;
    while (!empty())
    {
      if (std::chrono::steady_clock::now() > last_moment)
        tell(SIGKILL);
      erase(std::remove_if(begin(), end(), [](const Child &child) { return status_of(child) >= 0; }), end());
      std::this_thread::sleep_for(poll_interval);
    }
  }

private:
  void tell(int signal) const
  {
    for (const Child &child : *this)
      kill(child.process, signal);
  }
};

} // namespace

bool run_processes(const ProcessPool &pool)
{
  Children running;
  std::size_t next = 0;
  while (next < pool.n_jobs || !running.empty())
  {
    if (pool.stop())
      return false;
    for (; next < pool.n_jobs && running.size() < pool.limit; ++next)
      running.push_back({next, start_process(pool.start(next))});
    std::vector<std::size_t> jobs;
    for (const Child &child : running)
      jobs.push_back(child.job);
    pool.waiting(jobs);
    std::this_thread::sleep_for(poll_interval);
    for (auto child = running.begin(); child != running.end();)
    {
      const int status = status_of(*child);
      if (status < 0)
      {
        ++child;
        continue;
      }
      const std::size_t job = child->job;
      child = running.erase(child);
      // A child may have had the signal before this process: from a terminal all of them get it.
      if (pool.stop())
        return false;
      pool.ended(job, status);
    }
  }
  return true;
}

} // namespace verification
