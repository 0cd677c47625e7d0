#include "support/dynamic_threads.h"

#include <algorithm>
#include <utility>

#include <omp.h>

#include <gtest/gtest.h>

namespace dynamic_threads_test
{

using latcon::support::DynamicThreads;

// Time that a step takes [s], and the share of one core that the process gets meanwhile.
struct Load
{
  double step, share;
};

// Machine on which steps take a time that depends on the number of threads.
struct Machine
{
  Load all, single;
};

double wall, processor; // clocks [s]

// Performs steps for a time [s]. @return number of steps per second
double steps_per_second(DynamicThreads &threads, const Machine &machine, double duration)
{
  const double begin = wall;
  double steps = 0.;
  for (; wall < begin + duration; ++steps)
  {
    threads.begin_step(0);
    const Load &load = omp_get_max_threads() > 1 ? machine.all : machine.single;
    wall += load.step;
    processor += load.share * load.step;
  }
  return steps / (wall - begin);
}

constexpr Machine idle{{0.006, 3.2}, {0.01, 1.}}, slower_on_all{{0.06, 2.4}, {0.04, 0.25}},
  slower_on_one{{0.03, 2.4}, {0.05, 0.3}};

class DynamicThreadsTest : public testing::Test
{
protected:
  void TearDown() override { omp_set_num_threads(before_); }
  const int before_ = omp_get_max_threads();
  DynamicThreads threads_{4, {[] { return wall; }, [] { return processor; }}};
};

TEST_F(DynamicThreadsTest, UseAllOnAnIdleMachine)
{
  EXPECT_NEAR(steps_per_second(threads_, idle, 50.), 1. / idle.all.step, 1e-6);
  EXPECT_EQ(omp_get_max_threads(), 4);
}

TEST_F(DynamicThreadsTest, AreAsFastAsTheFasterNumberOnABusyMachine)
{
  for (const Machine &machine : {slower_on_all, slower_on_one, slower_on_all})
    EXPECT_GT(steps_per_second(threads_, machine, 50.), 0.95 / std::min(machine.all.step, machine.single.step));
}

TEST_F(DynamicThreadsTest, AreAllUsedAgainOnceCoresAreFree)
{
  steps_per_second(threads_, slower_on_all, 50.);
  steps_per_second(threads_, idle, 3.);
  EXPECT_NEAR(steps_per_second(threads_, idle, 50.), 1. / idle.all.step, 1e-6);
}

TEST_F(DynamicThreadsTest, LeaveACoreToEachOther)
{
  for (const auto &[others, expected] : {std::pair(1, 3), {0, 4}, {4, 1}})
  {
    threads_.begin_step(others);
    EXPECT_EQ(omp_get_max_threads(), expected);
  }
}

TEST_F(DynamicThreadsTest, AreLeftAloneIfThereIsOne)
{
  omp_set_num_threads(3);
  DynamicThreads one(1, {[] { return wall; }, [] { return processor; }});
  steps_per_second(one, slower_on_all, 5.);
  EXPECT_EQ(omp_get_max_threads(), 3);
}

} // namespace dynamic_threads_test
