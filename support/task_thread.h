/// Tasks on another thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <utility>

namespace latcon::support
{

/// Performs tasks beside the owner's thread, one after the other in the order in which they were added. What a task
/// holds is freed when it ends, before the next may be added.
///
/// An exception that a task throws is rethrown to the owner by the next call of add(), check() or wait(); tasks that
/// were added before that call are not performed any more. Only the owner's thread may call these. The destructor waits
/// until the pending tasks have been performed; an exception that they throw is lost.
class TaskThread
{
public:
  /// Tasks that are not done, including the one that is being performed: a bound of the memory that they hold.
  static constexpr std::size_t max_pending = 2;

  TaskThread() = default;
  TaskThread(const TaskThread &) = delete;
  TaskThread &operator=(const TaskThread &) = delete;

  /// Adds a task; waits until fewer than max_pending are pending.
  void add(std::function<void()> task)
  {
    wait_until_pending(max_pending - 1);
    auto perform = [before = pending_.empty() ? Future() : pending_.back(), task = std::move(task)]() mutable
    {
      if (before.valid())
        std::exchange(before, {}).get(); // throws what an earlier task has thrown
      std::exchange(task, nullptr)();
    };
    pending_.push_back(std::async(std::launch::async, std::move(perform)));
  }

  /// Waits until all tasks have been performed.
  void wait() { wait_until_pending(0); }

  /// Rethrows the exception of a task, without waiting for those that are pending.
  void check() { wait_until_pending(max_pending); }

  /// Returns whether a task is being performed, or about to be.
  bool is_busy() const { return !pending_.empty() && !is_done(pending_.back()); }

private:
  using Future = std::shared_future<void>; // its destructor waits for the task

  static bool is_done(const Future &task)
  {
    return task.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  void wait_until_pending(std::size_t at_most)
  {
    while (!pending_.empty() && (pending_.size() > at_most || is_done(pending_.front())))
      try
      {
        const Future first = std::move(pending_.front());
        pending_.pop_front();
        first.get();
      }
      catch (...)
      {
        pending_.clear();
        throw;
      }
  }

  std::deque<Future> pending_; // each waits for the one before
};

} // namespace latcon::support
