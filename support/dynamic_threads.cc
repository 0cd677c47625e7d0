#include "support/dynamic_threads.h"

#include <algorithm>
#include <ctime>

#include <omp.h>

namespace latcon::support
{
namespace
{

// Time between two choices [s]: several times that in which the system gives each of a dozen programs its turn.
constexpr double interval = 0.1;

// Number of choices of which one tries the slower number again.
constexpr std::size_t choices_per_trial = 16;

// Share of their cores below which threads wait for cores. Those of an idle machine get nearly all, since they wait for
// each other busily.
constexpr double share_of_cores = 0.7;

template <clockid_t clock>
double seconds()
{
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

DynamicThreads::DynamicThreads(int n_threads)
  : DynamicThreads(n_threads, {seconds<CLOCK_MONOTONIC>, seconds<CLOCK_PROCESS_CPUTIME_ID>})
{
}

DynamicThreads::DynamicThreads(int n_threads, Clocks clocks) : n_threads_(n_threads), clocks_(clocks) {}

void DynamicThreads::begin_step(int n_others)
{
  if (n_threads_ == 1)
    return;
  if (const double now = clocks_.wall(); n_steps_ == 0 || now - wall_ >= interval)
  {
    const double processor = clocks_.processor();
    if (n_steps_ > 0)
      choose(now - wall_, processor - processor_);
    wall_ = now;
    processor_ = processor;
    n_steps_ = 0;
  }
  ++n_steps_;
  omp_set_num_threads(is_single_ ? 1 : std::max(1, n_threads_ - n_others));
}

void DynamicThreads::choose(double wall_time, double processor_time)
{
  if (!is_single_ && processor_time >= share_of_cores * n_threads_ * wall_time)
  {
    time_per_step_ = {};
    n_choices_ = 0;
    return;
  }
  const auto here = static_cast<std::size_t>(is_single_), there = 1 - here;
  const double measured = wall_time / static_cast<double>(n_steps_);
  time_per_step_[here] = time_per_step_[here] > 0. ? 0.5 * (time_per_step_[here] + measured) : measured;
  const bool is_trial = time_per_step_[there] == 0. || ++n_choices_ % choices_per_trial == 0;
  is_single_ = is_trial ? !is_single_ : time_per_step_[1] < time_per_step_[0];
}

} // namespace latcon::support
