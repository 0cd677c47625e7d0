#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/full_precision.h"

namespace full_precision_test
{

using latcon::support::full_precision;

std::uint64_t bits(const double value)
{
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof(value));
  return result;
}

TEST(FullPrecision, IsShortAndReadsBackBitForBit)
{
  EXPECT_EQ(full_precision(0.1), "0.1");
  EXPECT_EQ(full_precision(-0.), "-0");
  EXPECT_EQ(full_precision(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(full_precision(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(full_precision(-std::numeric_limits<double>::infinity()), "-inf");
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i)
  {
    const std::uint64_t pattern = random();
    double value = 0.;
    std::memcpy(&value, &pattern, sizeof(value));
    if (std::isfinite(value))
    {
      EXPECT_EQ(bits(std::strtod(full_precision(value).c_str(), nullptr)), pattern);
    }
  }
}

} // namespace full_precision_test
