// The available memory is the smallest of those in /proc and in the control groups.
#include "support/machine_memory.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace machine_memory_test
{

using latcon::support::available_memory;
using latcon::support::readable_bytes;

class MachineMemory : public testing::Test
{
protected:
  void put_available(const std::string &kibibytes)
  {
    root_.write("proc/meminfo",
                "MemTotal:       2000 kB\nMemFree:         1 kB\nMemAvailable:   " + kibibytes + " kB\n");
  }
  double available() { return available_memory(root_.path()); }

  TemporaryFolder root_;
};

TEST_F(MachineMemory, IsWhatTheSystemHasAvailable)
{
  put_available("1000");
  EXPECT_EQ(available(), 1024000.);
}

TEST_F(MachineMemory, IsInfiniteWhereNothingIsSaid)
{
  EXPECT_TRUE(std::isinf(available()));
}

TEST_F(MachineMemory, IsLimitedByAControlGroupAndThoseAroundIt)
{
  put_available("1000");
  root_.write("proc/self/cgroup", "0::/outer/inner\n");
  root_.write("sys/fs/cgroup/outer/memory.max", "500000\n");
  root_.write("sys/fs/cgroup/outer/memory.current", "300000\n");
  root_.write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  root_.write("sys/fs/cgroup/outer/inner/memory.current", "300000\n");
  EXPECT_EQ(available(), 200000.);
  root_.write("sys/fs/cgroup/outer/memory.stat", "anon 1\ninactive_file 50000\n");
  EXPECT_EQ(available(), 250000.);
  root_.write("sys/fs/cgroup/outer/inner/memory.max", "310000\n");
  EXPECT_EQ(available(), 10000.);
  root_.write("sys/fs/cgroup/outer/inner/memory.max", "1000\n");
  EXPECT_EQ(available(), 0.);
}

// A container sees its own group at the root of the hierarchy.
TEST_F(MachineMemory, IsLimitedByTheGroupThatIsMounted)
{
  put_available("1000");
  root_.write("proc/self/cgroup", "0::/not/seen/here\n");
  root_.write("sys/fs/cgroup/memory.max", "400000\n");
  root_.write("sys/fs/cgroup/memory.current", "100000\n");
  EXPECT_EQ(available(), 300000.);
}

TEST_F(MachineMemory, IsLimitedByGroupsOfTheFirstVersion)
{
  put_available("1000");
  root_.write("proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/a\n0::/\n");
  root_.write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "90000\n");
  root_.write("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "20000\n");
  root_.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  root_.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "20000\n");
  EXPECT_EQ(available(), 70000.);
}

TEST(ReadableBytes, HaveThreeDigitsAndAUnit)
{
  EXPECT_EQ(readable_bytes(0.), "0 B");
  EXPECT_EQ(readable_bytes(999.), "999 B");
  EXPECT_EQ(readable_bytes(999.7), "1 kB");
  EXPECT_EQ(readable_bytes(1234567.), "1.23 MB");
  EXPECT_EQ(readable_bytes(1e21), "1e+03 EB");
}

} // namespace machine_memory_test
