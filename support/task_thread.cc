#include "support/task_thread.h"

#include <utility>

namespace latcon::support
{

TaskThread::~TaskThread()
{
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable())
    thread_.join();
}

void TaskThread::add(std::function<void()> task)
{
  wait_until_pending(max_pending - 1);
  {
    const std::lock_guard lock(mutex_);
    pending_.push_back(std::move(task));
  }
  changed_.notify_all();
  if (!thread_.joinable())
    thread_ = std::thread(&TaskThread::perform_tasks, this);
}

void TaskThread::wait_until_pending(std::size_t at_most)
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return pending_.size() <= at_most; });
  if (error_)
    std::rethrow_exception(std::exchange(error_, nullptr));
}

bool TaskThread::is_busy()
{
  const std::lock_guard lock(mutex_);
  return !pending_.empty();
}

void TaskThread::perform_tasks()
{
  std::unique_lock lock(mutex_);
  while (true)
  {
    changed_.wait(lock, [this] { return !pending_.empty() || is_ending_; });
    if (pending_.empty())
      return;
    std::function<void()> task = std::move(pending_.front());
    lock.unlock();
    std::exception_ptr error;
    try
    {
      task();
    }
    catch (...)
    {
      error = std::current_exception();
    }
    task = nullptr; // what it holds, before the next one may be added
    lock.lock();
    if (error)
    {
      pending_.clear();
      error_ = error;
    }
    else
      pending_.pop_front();
    changed_.notify_all();
  }
}

} // namespace latcon::support
