#include "verification/output/progress.h"

#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace progress_test
{

using namespace latcon;

using output::Progress;
using namespace std::chrono_literals;

TEST(Progress, WritesLinesToADumbTerminal)
{
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY), old = dup(STDERR_FILENO);
  ASSERT_EQ(grantpt(terminal) + unlockpt(terminal), 0);
  const int end = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  dup2(end, STDERR_FILENO);
  setenv("TERM", "dumb", 1);
  Progress(true, 0., 1h).show("step 1", 0.);
  dup2(old, STDERR_FILENO);
  char shown[80] = {};
  EXPECT_EQ(read(terminal, shown, sizeof(shown) - 1), 8);
  EXPECT_STREQ(shown, "step 1\r\n");
  for (const int file : {terminal, end, old})
    close(file);
}

// Output to standard error, which is not a terminal here.
TEST(Progress, AddsALineToALogEverySoOften)
{
  testing::internal::CaptureStderr();
  {
    Progress progress(true, 0., 5ms);
    EXPECT_FALSE(Progress(true, 0., 1h).due());
    EXPECT_FALSE(Progress(false, 0., 0ms).due()); // not wanted
    Progress(false, 0., 0ms).show("nothing", 0.5);
    std::this_thread::sleep_for(6ms);
    EXPECT_TRUE(progress.due());
    progress.show("step 1", 0.);
    std::this_thread::sleep_for(6ms);
    EXPECT_TRUE(progress.due());
    progress.show("step 2", 1.);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "step 1\nstep 2, 0 s left\n");
}

// A resumed run of which this process has done a hundredth in at least 50 ms: 74 are left.
TEST(Progress, EstimatesFromWhatThisProcessHasDone)
{
  testing::internal::CaptureStderr();
  {
    Progress progress(true, 0.25, 1h);
    std::this_thread::sleep_for(50ms);
    progress.show("step 2", 0.255);
    progress.show("step 3", 0.26);
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  int left = 0;
  ASSERT_EQ(std::sscanf(shown.c_str(), "step 2\nstep 3, %d s left", &left), 1) << shown;
  EXPECT_GE(left, 4);
}

} // namespace progress_test
