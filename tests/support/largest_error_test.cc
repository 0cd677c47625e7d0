// Values that are not finite propagate to errors and extremes at any position of the sequence.
#include "support/largest_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace largest_error_test
{

using namespace latcon::support;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array not_finite{not_a_number, infinity, -infinity};

TEST(LargestError, IsTheLargestWithItsValueAndReference)
{
  LargestError error;
  error.add_relative(1.1, 1.);
  error.add_relative(0.8, 1.);
  error.add_relative(2.1, 2.);
  EXPECT_DOUBLE_EQ(error.error(), 0.2);
  EXPECT_EQ(error.value(), 0.8);
  EXPECT_EQ(error.reference(), 1.);
  error.add_difference(-3., 2.);
  EXPECT_EQ(error.error(), 5.);
  EXPECT_EQ(error.value(), -3.);
}

// Signed errors, which may all be negative: distances inside a bound.
TEST(LargestError, OfNegativeErrorsIsTheOneNextToTheBound)
{
  LargestError error;
  error.add(-2., 7.);
  error.add(-1., 8.);
  error.add(-3., 9.);
  EXPECT_EQ(error.error(), -1.);
  EXPECT_EQ(error.value(), 8.);
}

TEST(LargestError, SticksAtTheFirstThatIsNotFinite)
{
  for (const double bad : not_finite)
    for (std::size_t place = 0; place < 3; ++place)
    {
      LargestError error;
      std::array values{1., 2., 3.};
      values[place] = bad;
      for (std::size_t i = 0; i < 3; ++i)
        error.add(1e-7 * values[i], i == place ? 5. : 1., 2.);
      EXPECT_TRUE(std::isnan(error.error())) << bad << " at " << place;
      EXPECT_EQ(error.value(), 5.) << "the value that is to blame";
      EXPECT_TRUE(std::isnan(largest_of({values[0], values[1], values[2]}))) << bad << " at " << place;
      EXPECT_TRUE(std::isnan(smallest_of({values[0], values[1], values[2]}))) << bad << " at " << place;
    }
}

TEST(LargestError, OfNothingIsNoNumber)
{
  EXPECT_TRUE(std::isnan(LargestError().error()));
  EXPECT_TRUE(std::isnan(Extremes().smallest()));
  EXPECT_TRUE(std::isnan(Extremes().largest()));
}

TEST(LargestError, OneSidedAndRelativeErrorsKeepWhatIsNotFinite)
{
  EXPECT_EQ(one_sided(-1e-3), 0.);
  EXPECT_FALSE(std::signbit(one_sided(-1e-3)));
  EXPECT_EQ(one_sided(2e-3), 2e-3);
  for (const double bad : not_finite)
    EXPECT_TRUE(std::isnan(one_sided(bad)));
  EXPECT_DOUBLE_EQ(relative_error(-1., 2.), 1.5);
  for (const auto &[value, reference] : {std::pair(1., 0.), {0., 0.}, {not_a_number, 1.}, {1., not_a_number}})
    EXPECT_TRUE(std::isnan(relative_error(value, reference)));
}

TEST(Extremes, KeepBothEnds)
{
  EXPECT_EQ(largest_of({-3., -1., -2.}), -1.);
  EXPECT_EQ(smallest_of({3., 1., 2.}), 1.);
  Extremes extremes;
  for (const double value : {2., -1., 4., 0.})
    extremes.add(value);
  EXPECT_EQ(extremes.smallest(), -1.);
  EXPECT_EQ(extremes.largest(), 4.);
}

} // namespace largest_error_test
