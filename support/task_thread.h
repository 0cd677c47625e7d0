/// Tasks on a thread of their own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace latcon::support
{

/// Performs tasks on a thread of its own, in the order in which they were added.
///
/// An exception that a task throws is rethrown to the owner by the next call of add(), check() or wait(); tasks that
/// were added before that call are not performed any more. Only the owner's thread may call these.
class TaskThread
{
public:
  /// Tasks that are not done, including the one that is being performed: a bound of the memory that they hold.
  static constexpr std::size_t max_pending = 2;

  TaskThread() = default;
  TaskThread(const TaskThread &) = delete;
  TaskThread &operator=(const TaskThread &) = delete;

  /// Performs the pending tasks. An exception that they throw is lost.
  ~TaskThread();

  /// Adds a task; waits until fewer than max_pending are pending. The first call starts the thread.
  void add(std::function<void()> task);

  /// Waits until all tasks have been performed.
  void wait() { wait_until_pending(0); }

  /// Rethrows the exception of a task, without waiting for those that are pending.
  void check() { wait_until_pending(max_pending); }

  /// Returns whether a task is being performed, or about to be.
  bool is_busy();

private:
  void perform_tasks();
  void wait_until_pending(std::size_t at_most);

  std::mutex mutex_; // of what follows
  std::condition_variable changed_;
  std::deque<std::function<void()>> pending_; // the first is being performed
  std::exception_ptr error_;
  bool is_ending_ = false;

  std::thread thread_;
};

} // namespace latcon::support
