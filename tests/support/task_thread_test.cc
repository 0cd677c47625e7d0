#include "support/task_thread.h"

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace task_thread_test
{

using latcon::support::TaskThread;

// A task that waits until it may end.
struct Gate
{
  std::promise<void> opened;
  std::shared_future<void> open = opened.get_future().share();
  std::function<void()> task() const
  {
    return [open = open] { open.wait(); };
  }
};

TEST(TaskThread, PerformsTasksInOrderOnAnotherThread)
{
  std::vector<int> order;
  std::thread::id id;
  TaskThread thread;
  for (int i = 0; i < 50; ++i)
    thread.add(
      [&, i]
      {
        order.push_back(i);
        id = std::this_thread::get_id();
      });
  thread.wait();
  ASSERT_EQ(order.size(), 50u);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
  EXPECT_NE(id, std::this_thread::get_id());
}

TEST(TaskThread, ReturnsWhileATaskIsPerformedAndWaitsBeyondTheBound)
{
  Gate gate;
  TaskThread thread;
  thread.add(gate.task());
  for (std::size_t pending = 1; pending < TaskThread::max_pending; ++pending)
    thread.add([] {});
  thread.check();
  EXPECT_TRUE(thread.is_busy());
  std::atomic<bool> added{false};
  std::future<void> more = std::async(std::launch::async,
                                      [&]
                                      {
                                        thread.add([] {});
                                        added = true;
                                      });
  EXPECT_EQ(more.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  EXPECT_FALSE(added);
  gate.opened.set_value();
  more.get();
  thread.wait();
  EXPECT_FALSE(thread.is_busy());
}

TEST(TaskThread, RethrowsOnceAndDiscardsWhatWasAddedBefore)
{
  for (int call = 0; call < 3; ++call)
  {
    Gate gate;
    bool performed = false;
    TaskThread thread;
    thread.add(
      [open = gate.open]
      {
        open.wait();
        throw std::runtime_error("full");
      });
    thread.add([&] { performed = true; });
    gate.opened.set_value();
    try
    {
      if (call == 0)
        thread.wait();
      else if (call == 1)
        thread.add([&] { performed = true; });
      else
        while (true)
          thread.check();
      ADD_FAILURE() << "no exception";
    }
    catch (const std::runtime_error &error)
    {
      EXPECT_EQ(error.what(), std::string("full"));
    }
    thread.wait();
    EXPECT_FALSE(performed);
    thread.add([&] { performed = true; });
    thread.wait();
    EXPECT_TRUE(performed);
  }
}

TEST(TaskThread, PerformsPendingTasksBeforeItEnds)
{
  Gate gate;
  int performed = 0;
  std::future<void> open;
  {
    TaskThread thread;
    thread.add(gate.task());
    thread.add([&] { ++performed; });
    open = std::async(std::launch::async,
                      [&]
                      {
                        std::this_thread::sleep_for(std::chrono::milliseconds(20));
                        gate.opened.set_value();
                      });
  }
  EXPECT_EQ(performed, 1);
}

} // namespace task_thread_test
