/// Pool of child processes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace latcon::study
{

/// Jobs and callbacks of a pool. The thread that called run_processes() calls all functions.
struct ProcessPool
{
  std::size_t n_jobs = 0;
  std::size_t limit = 1; ///< largest number of concurrent children, >= 1

  /// Command of a job, requested just before it starts.
  struct Job
  {
    std::vector<std::string> command; ///< path of the program, followed by its arguments
    std::string log;                  ///< file for standard output and standard error; replaced if it exists
  };
  std::function<Job(std::size_t)> start;
  /// Called when a job has ended. Status: exit status of the job, 128 + the signal that killed it, or 127 if it could
  /// not be started.
  std::function<void(std::size_t, int status)> ended;
  /// Called several times per second with the running jobs, in the order in which they started.
  std::function<void(const std::vector<std::size_t> &)> waiting = [](const std::vector<std::size_t> &) {};
  /// Called equally often; returns true to end early. Then no more jobs start, and running jobs get SIGTERM, and
  /// SIGKILL a minute later.
  std::function<bool()> stop = [] { return false; };
};

/// Runs the jobs in their order, at most `limit` at a time, and waits for all of them. Children have no standard input
/// and no variables of Open MPI and of launchers (OMPI_*, PMIX_*, support::is_launcher_variable), so that each child is
/// a separate MPI job. They get SIGTERM if this process dies. A failed job does not stop the others. Exceptions of the
/// functions are propagated after all children have ended.
/// @return true if all jobs ended by themselves; `ended` is called only for jobs that did
bool run_processes(const ProcessPool &pool);

} // namespace latcon::study
