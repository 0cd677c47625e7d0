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
  Progress(true, 1h).show("step 1", 0.);
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
    Progress progress(true, 5ms);
    EXPECT_FALSE(Progress(true, 1h).due());
    std::this_thread::sleep_for(6ms);
    EXPECT_TRUE(progress.due());
    progress.show("step 1", 0.);
    std::this_thread::sleep_for(6ms);
    EXPECT_TRUE(progress.due());
    progress.show("step 2", 1.);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "step 1\nstep 2, 0 s left\n");
}

TEST(Progress, IsSilentWhereItIsNotWanted)
{
  testing::internal::CaptureStderr();
  {
    Progress progress(false, 0ms);
    EXPECT_FALSE(progress.due());
    progress.show("step 1", 0.5);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace progress_test
