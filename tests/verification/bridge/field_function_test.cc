#include "verification/bridge/affine_displacement.h"

#include <cmath>

#include <gtest/gtest.h>

namespace field_function_test
{

using namespace latcon;

TEST(FieldFunction, GradientsOfExpressionsAreOfFourthOrder)
{
  input::FieldCase sine;
  sine.x = "sin(100 * x)";
  const double extent = 0.02;
  // Five-point formula: h^4 / 30 times the fifth derivative 100^5, and round-off over h.
  const double h = 1e-3 * extent;
  EXPECT_NEAR(bridge::FieldFunction(sine, extent).gradient({0.003, 0.}, 0)[0], 100. * std::cos(0.3),
              std::pow(h, 4) * 1e10 / 30. + 1e-15 / h);
}

} // namespace field_function_test
