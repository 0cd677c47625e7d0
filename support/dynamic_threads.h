/// Dynamic adjustment of the number of OpenMP threads.
#pragma once

#include <array>
#include <cstddef>

namespace latcon::support
{

/// Number of OpenMP threads of a loop whose steps contain many barriers: all, or one while other programs occupy the
/// cores. Each barrier then waits for the thread that gets a core last, and several threads may be slower than one.
///
/// While the threads get less than 0.7 of the time of as many cores, the time per step is measured on all of them and on
/// one, and the faster number is used. The other one is tried now and then, and all are used again when cores are free.
/// Only for loops whose results do not depend on the number of threads.
class DynamicThreads
{
public:
  /// Clocks [s]; tests pass their own.
  struct Clocks
  {
    double (*wall)();
    double (*processor)(); ///< time of all threads of the process
  };

  /// @param n_threads number of all threads, >= 1; with one thread nothing is adjusted
  explicit DynamicThreads(int n_threads);
  DynamicThreads(int n_threads, Clocks clocks);

  /// Sets the number of threads of the parallel regions that the calling thread starts. To be called before each step.
  /// @param n_others threads of the process that work beside them, and get cores of their own
  void begin_step(int n_others);

private:
  void choose(double wall_time, double processor_time);

  int n_threads_;
  Clocks clocks_;
  bool is_single_ = false;                // one thread is used
  std::array<double, 2> time_per_step_{}; // [s] on all threads, on one; 0: not known
  std::size_t n_choices_ = 0;             // since cores were free
  std::size_t n_steps_ = 0;               // since wall_, as is processor_
  double wall_ = 0., processor_ = 0.;     // [s]
};

} // namespace latcon::support
