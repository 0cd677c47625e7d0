#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"

namespace claims_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

TEST(Energy, HoldsForBothShellSetsOrientationsAndLaws)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
    for (const auto law : {ShellCase::Law::mooney_rivlin, ShellCase::Law::linear})
    {
      Case input = subjects::paper_case();
      input.orientation = orientation;
      input.nearest.law = input.next_nearest.law = law;
      input.nearest.modulus = input.next_nearest.modulus = 2.35e5;
      for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
      {
        const Results results = parts::energy.check(subject(input, material));
        // Strong ellipticity of the calibrated law is judged for rubber alone: springs are another material.
        for (const Result &row : results.rows())
          EXPECT_TRUE(row.verdict() != Verdict::fails) << row.quantity;
        EXPECT_GE(faults::holding(results), 10u);
      }
    }
}

TEST(Prestretch, HoldsForBothShellSetsAcrossTheCrack)
{
  faults::expect_holds([](const Case &, const Subject &subject) { return parts::prestretch.check(subject); });
}

// The strain-controlled test of rubber, and a loading on whose way the fitted law loses ellipticity.
TEST(Energy, LawsThatAreNotUsedAreReported)
{
  for (const auto &[x, y] : {std::pair(0., 0.3), std::pair(0., 1.8), std::pair(2., 0.5)})
  {
    Case input = subjects::paper_case();
    input.strain_x = x;
    input.strain_y = y;
    for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
    {
      EXPECT_TRUE(energy_claim(subject(input, material, laws_of_lattice()), 10).all_hold()) << x << " " << y;
      const Results judged = energy_claim(subject(input, material), 10);
      EXPECT_EQ(faults::failing(judged), x == 2. ? 1u : 0u) << x << " " << y;
      if (x == 2.)
      {
        EXPECT_EQ(faults::failing(judged, "loses ellipticity"), 1u) << y;
      }
    }
  }
}

const Result &row_with(const Results &results, const std::string &text)
{
  for (const Result &row : results.rows())
    if (row.quantity.find(text) != std::string::npos)
      return row;
  throw std::logic_error("no row has " + text);
}

TEST(Energy, RatioAtTheEndOfItsIntervalIsSaidToBe)
{
  Case input = subjects::paper_case();
  input.strain_x = 0.;
  Subject sheared = subject(input);
  EXPECT_EQ(sheared.mooney_rivlin->ratio, largest_ratio);
  EXPECT_EQ(row_with(energy_claim(sheared, 10), "at the end of the search interval").verdict(), Verdict::holds);
  // The other end is no best ratio: the residual falls inwards.
  sheared.mooney_rivlin = with_ratio(input.lattice(), input.material(), input.deformation(), -0.3);
  EXPECT_EQ(row_with(energy_claim(sheared, 10), "slope of the residual").verdict(), Verdict::fails);
  const Subject interior = subject(subjects::paper_case());
  EXPECT_LT(std::abs(interior.mooney_rivlin->ratio), 0.89);
  EXPECT_EQ(row_with(energy_claim(interior, 10), "error: slope of the residual there").verdict(), Verdict::holds);
}

TEST(Prestretch, SheetThatBucklesFailsAndIsNotCompared)
{
  Case input = subjects::paper_case();
  input.strain_x = -0.3;
  const Subject buckled = subject(input);
  EXPECT_FALSE(buckled.is_stable());
  const Results results = parts::prestretch.check(buckled);
  ASSERT_EQ(results.rows().size(), 1u);
  EXPECT_NE(results.rows()[0].quantity.find("it buckles in waves of kd = "), std::string::npos);
  EXPECT_EQ(results.rows()[0].verdict(), Verdict::fails);
}

} // namespace claims_test
