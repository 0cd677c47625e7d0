/// Child processes, as many at once as there are cores for.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace latcon::study
{

/// What a pool runs and whom it tells. All functions are called by the thread that called run_processes().
struct ProcessPool
{
  std::size_t n_jobs = 0;
  std::size_t limit = 1; ///< most children at once, >= 1

  /// What a job is, asked for just before it starts.
  struct Job
  {
    std::vector<std::string> command; ///< path of the program, then its arguments
    std::string log;                  ///< file that standard output and standard error go to; replaced
  };
  std::function<Job(std::size_t)> start;
  /// A job has ended. Status: what it exited with, 128 + the signal that killed it, 127 if it could not be started.
  std::function<void(std::size_t, int status)> ended;
  /// Called some times a second with the jobs that run, in the order in which they started.
  std::function<void(const std::vector<std::size_t> &)> waiting = [](const std::vector<std::size_t> &) {};
  /// Asked as often: whether to end early. Then no job starts, running ones get SIGTERM, and SIGKILL a minute later.
  std::function<bool()> stop = [] { return false; };
};

/// Starts the jobs in their order, at most `limit` at once, and waits for all of them. Children have no standard input
/// and none of the variables of Open MPI and of launchers (OMPI_*, PMIX_*, support::is_launcher_variable), so that each
/// child is an MPI job of its own. They get SIGTERM if this process dies. A job that fails stops no other. Exceptions
/// of the functions are passed on once no child is left.
/// @return whether all jobs ended by themselves; `ended` was called for these alone
bool run_processes(const ProcessPool &pool);

} // namespace latcon::study
