// Bars of the continuum with damage, and faults that make their claim fail.
#include "verification/bridge/damaged_sheet.h"
#include "verification/claims/damage/damage_claim.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/verification/claims/faults.h"

namespace claims_damage_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

ClaimOutcome outcome(const Case &input, const DamageOptions &options = DamageOptions())
{
  const Subject one = subject(input);
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
  DamageOptions at_rest;
  at_rest.has_motion = false; // short
  const ClaimOutcome linear = outcome(input, at_rest);
  EXPECT_TRUE(linear.results.all_hold()) << linear.results.verdict_text(9);
}

// Quantities of the rows that fail, without the name of the subject.
std::vector<std::string> failing(DamageOptions options, bool has_motion = false)
{
  options.has_motion = has_motion;
  Case input = subjects::paper_case();
  input.breaking_stretch = 3.05;
  const Results results = outcome(input, options).results;
  std::vector<std::string> quantities;
  for (const Result &row : results.rows())
    if (row.verdict() == Verdict::fails)
      quantities.push_back(row.quantity.substr(row.quantity.find(": ") + 2));
  return quantities;
}

TEST(DamageClaim, FailsForAnotherEnergyOfACrack)
{
  DamageOptions options;
  options.planted_toughness = 1.01;
  const std::vector<std::string> quantities = failing(options);
  for (const char *expected :
       {"energy of a crack over G_c, local, h = xi/2", "energy of a crack over G_c, local, h = xi/4",
        "energy of a crack over G_c, extrapolated in h", "energy of a crack over G_c, gradient, h = xi/4",
        "damage of a homogeneous bar at 1.5 of the critical strain", "energy dissipated in a homogeneous bar"})
    EXPECT_EQ(std::count(quantities.begin(), quantities.end(), expected), 1) << expected;
}

TEST(DamageClaim, FailsForAnotherEnergyOfACrackInMotion)
{
  for (const double factor : {0.8, 1.3}) // the second one does not run
  {
    DamageOptions options;
    options.planted_toughness = factor;
    const std::vector<std::string> quantities = failing(options, true);
    EXPECT_EQ(
      std::count(quantities.begin(), quantities.end(), "in motion, energy of a steady crack over G_c, h = xi/2"), 1)
      << factor;
  }
}

// Two faults in one run: neither has a part in the rows of the other.
TEST(DamageClaim, FailsIfDamageHealsOrLeavesTheGradientEnergy)
{
  DamageOptions options;
  options.planted_healing = options.planted_undegraded_gradient = true;
  EXPECT_EQ(failing(options), (std::vector<std::string>{"stress after unloading to 0.5 of the critical strain",
                                                        "stress after unloading to 1.4 of the critical strain",
                                                        "gradient energy with damage 0.5 over that without"}));
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

} // namespace claims_damage_test
