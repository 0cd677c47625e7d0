#include "support/available_cores.h"

#include <algorithm>
#include <cmath>

#include <sched.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace available_cores_test
{

using latcon::support::available_cores;
using latcon::support::processor_quota;

TEST(AvailableCores, AreThoseThatTheSchedulerMayUse)
{
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  EXPECT_EQ(available_cores(),
            std::max(1U, static_cast<unsigned int>(std::min<double>(CPU_COUNT(&before), processor_quota()))));
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

class ProcessorQuota : public testing::Test
{
protected:
  double quota() { return processor_quota(root_.path()); }

  TemporaryFolder root_;
};

TEST_F(ProcessorQuota, IsThatOfTheNarrowestGroup)
{
  EXPECT_TRUE(std::isinf(quota()));
  root_.write("proc/self/cgroup", "0::/outer/inner\n");
  EXPECT_TRUE(std::isinf(quota()));
  root_.write("sys/fs/cgroup/cpu.max", "max 100000\n");
  root_.write("sys/fs/cgroup/outer/cpu.max", "150000 100000\n");
  root_.write("sys/fs/cgroup/outer/inner/cpu.max", "max 100000\n");
  EXPECT_EQ(quota(), 1.5);
  root_.write("sys/fs/cgroup/outer/inner/cpu.max", "50000 100000\n");
  EXPECT_EQ(quota(), 0.5);
}

TEST_F(ProcessorQuota, IsReadFromGroupsOfTheFirstVersion)
{
  root_.write("proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/a\n");
  root_.write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  root_.write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_TRUE(std::isinf(quota()));
  root_.write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "200000\n");
  root_.write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(quota(), 2.);
}

} // namespace available_cores_test
