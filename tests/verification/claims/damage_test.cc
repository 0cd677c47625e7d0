// Bars of the damaging continuum, and faults that make their claim fail.
#include "verification/claims/damage/damage_claim.h"

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"

using namespace latcon;

namespace
{

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

ClaimOutcome outcome(const Case &input, double planted_toughness = 1.)
{
  const Subject one = subject(input);
  DamageOptions options;
  options.planted_toughness = planted_toughness;
  return damage_claim(one, damage_law(input, one), options);
}

TEST(DamageClaim, Holds)
{
  Case input = subjects::paper_case();
  input.breaking_stretch = 3.05;
  const ClaimOutcome rubber = outcome(input);
  EXPECT_TRUE(rubber.results.all_hold()) << rubber.results.verdict_text(9);
  // Nodes of bars of 17, 33 and 33 elements.
  EXPECT_EQ(rubber.tables.at("damaged_bar").rows().size(), 18u + 34u + 34u);

  input.has_next_nearest = false;
  input.nearest = {ShellCase::Law::linear, 0., 0., 1e6, 1., 0.};
  input.breaking_stretch = 1.02;
  const ClaimOutcome linear = outcome(input);
  EXPECT_TRUE(linear.results.all_hold()) << linear.results.verdict_text(9);
}

TEST(DamageClaim, FailsForAnotherEnergyOfACrack)
{
  Case input = subjects::paper_case();
  input.breaking_stretch = 3.05;
  for (const double factor : {0.99, 1.01})
  {
    const Results results = outcome(input, factor).results;
    for (const Result &row : results.rows())
    {
      if (row.quantity.find("energy of a crack over G_c, local") != std::string::npos ||
          row.quantity.find("energy of a crack over G_c, gradient") != std::string::npos ||
          row.quantity.find("damage of a homogeneous bar") != std::string::npos ||
          row.quantity.find("energy dissipated") != std::string::npos)
      {
        EXPECT_EQ(row.verdict(), Verdict::fails) << row.quantity;
      }
    }
  }
}

TEST(DamageClaim, TakesTheConstantsFromTheBonds)
{
  Case input = subjects::paper_case();
  input.breaking_stretch = 2.;
  const Subject one = subject(input);
  dealii::Tensor<2, 2> F;
  F[0][0] = F[1][1] = 2.;
  EXPECT_EQ(damage_law(input, one).threshold, one.cauchy_born.energy(F));
  EXPECT_EQ(damage_law(input, one).length, input.spacing);
  input.continuum.damage_length = 1e-3;
  input.continuum.damage_threshold = 5.;
  input.continuum.residual_stiffness = 1e-5;
  const continuum::DamageLaw given = damage_law(input, one);
  EXPECT_EQ(given.length, 1e-3);
  EXPECT_EQ(given.threshold, 5.);
  EXPECT_EQ(given.residual_stiffness, 1e-5);
  input.continuum.damage_threshold.reset();
  input.breaking_stretch.reset();
  F[0][0] = F[1][1] = 3.;
  EXPECT_EQ(damage_law(input, one).threshold, one.cauchy_born.energy(F));
}

} // namespace
