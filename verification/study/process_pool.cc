#include "verification/study/process_pool.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include <unistd.h>

#include "support/child_process.h"
#include "support/mpi_session.h"

extern char **environ;

namespace latcon::study
{
namespace
{

constexpr std::chrono::milliseconds poll_interval(20);
constexpr std::chrono::seconds patience(60);

std::vector<std::string> environment_of_children()
{
  std::vector<std::string> kept;
  for (char **variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("OMPI_", 0) != 0 && text.rfind("PMIX_", 0) != 0 && !support::is_launcher_variable(text))
      kept.push_back(text);
  }
  return kept;
}

struct Child
{
  std::size_t job;
  pid_t process;
};

// List of running children that ends them on destruction.
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
      erase(std::remove_if(begin(), end(), [](const Child &child) { return support::poll_child(child.process) >= 0; }),
            end());
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
    {
      const ProcessPool::Job job = pool.start(next);
      running.push_back({next, support::start_child({job.command, environment_of_children(), job.log})});
    }
    std::vector<std::size_t> jobs;
    for (const Child &child : running)
      jobs.push_back(child.job);
    pool.waiting(jobs);
    std::this_thread::sleep_for(poll_interval);
    for (auto child = running.begin(); child != running.end();)
    {
      const int status = support::poll_child(child->process);
      if (status < 0)
      {
        ++child;
        continue;
      }
      const std::size_t job = child->job;
      child = running.erase(child);
      // A signal from a terminal goes to all processes, so a child may have received it before this process.
      if (pool.stop())
        return false;
      pool.ended(job, status);
    }
  }
  return true;
}

} // namespace latcon::study
