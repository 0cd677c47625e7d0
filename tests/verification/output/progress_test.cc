#include "verification/output/progress.h"

#include <thread>

#include <gtest/gtest.h>

using namespace latcon;

namespace
{

using output::Progress;
using namespace std::chrono_literals;

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

} // namespace
