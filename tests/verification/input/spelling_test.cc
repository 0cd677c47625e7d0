// Typing errors are counted as a typist would.
#include "verification/input/case_text.h"

#include <gtest/gtest.h>

namespace spelling_test
{

using namespace latcon;
using input::could_mean;
using input::nearest_word;
using input::typing_errors;

TEST(Spelling, CountsTypingErrors)
{
  EXPECT_EQ(typing_errors("", ""), 0u);
  EXPECT_EQ(typing_errors("spacing", "spacing"), 0u);
  EXPECT_EQ(typing_errors("Spacing", "spacing"), 0u);
  EXPECT_EQ(typing_errors("", "abc"), 3u);
  EXPECT_EQ(typing_errors("spacng", "spacing"), 1u);
  EXPECT_EQ(typing_errors("spacinng", "spacing"), 1u);
  EXPECT_EQ(typing_errors("spazing", "spacing"), 1u);
  EXPECT_EQ(typing_errors("sapcing", "spacing"), 1u);
  EXPECT_EQ(typing_errors("kitten", "sitting"), 3u);
  EXPECT_EQ(typing_errors("ca", "abc"), 3u); // the restricted distance: what was swapped is not changed again
}

TEST(Spelling, NearEnoughIsAThirdOfTheWordOrAPartOfIt)
{
  EXPECT_TRUE(could_mean("ab", "abcd"));
  EXPECT_FALSE(could_mean("xyz", "abcd"));
  EXPECT_FALSE(could_mean("x", "dt"));
  EXPECT_TRUE(could_mean("factor", "nearest neighbour area factor"));
  EXPECT_TRUE(could_mean("ne", "nearest neighbour area factor"));
  EXPECT_TRUE(could_mean("nearst nieghbor aera factor", "nearest neighbour area factor"));
  EXPECT_FALSE(could_mean("area x", "nearest neighbour area factor"));
}

TEST(Spelling, FindsTheNearestWord)
{
  EXPECT_EQ(nearest_word("brnching", {"straight", "oscillating", "branching"}), "branching");
  EXPECT_EQ(nearest_word("quite", {"straight", "oscillating", "branching"}), "");
  EXPECT_EQ(nearest_word("aa", {"ab", "ac"}), "ab");
  EXPECT_EQ(nearest_word("x", {}), "");
}

} // namespace spelling_test
