#include <sched.h>

#include <gtest/gtest.h>

#include "support/available_cores.h"

namespace available_cores_test
{

using latcon::support::available_cores;

TEST(AvailableCores, AreThoseThatTheSchedulerMayUse)
{
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  EXPECT_EQ(available_cores(), static_cast<unsigned int>(CPU_COUNT(&before)));
  int first = 0;
  while (!CPU_ISSET(first, &before))
    ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(available_cores(), 1U);
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

} // namespace available_cores_test
