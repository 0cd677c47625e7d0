// Without a fault claims hold.
#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/command.h"

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
        EXPECT_GE(results.count(Verdict::holds), 10u);
      }
    }
}

using Check = std::function<Results(const Case &, const Subject &)>;

using HeldClaim = testing::TestWithParam<std::pair<const char *, Check>>;

// The excess is there, with its sign: the gradient continuum holds more energy than the local one, the lattice less.
void expect_that_the_local_energy_is_between(const Table &table)
{
  const auto column = [&](const std::string &name)
  {
    const auto found = std::find(table.columns().begin(), table.columns().end(), name);
    return static_cast<std::size_t>(found - table.columns().begin());
  };
  EXPECT_EQ(table.rows().size(), 2u * 2u * 2u); // directions, kd, waves
  for (const auto &row : table.rows())
  {
    EXPECT_LT(std::get<double>(row[column("lattice")]), 1. - 1e-3);
    EXPECT_GT(std::get<double>(row[column("gradient")]), 1. + 1e-3);
  }
}

Results energy_of_waves(const Case &input, const Subject &subject)
{
  const ClaimOutcome outcome = parts::energy_of_waves(subject, {faults::state_for(input, subject)});
  EXPECT_EQ(outcome.results.count(Verdict::reported), 0u);
  if (subject.material.next_nearest) // nearest neighbours alone leave less than it judges
    expect_that_the_local_energy_is_between(outcome.tables.at("sinusoidal_energy"));
  return outcome.results;
}

Results wave_speeds(const Case &input, const Subject &subject)
{
  const ClaimOutcome outcome = wave_speeds_claim(subject, parts::waves({faults::state_for(input, subject)}));
  EXPECT_EQ(outcome.tables.at("wave_speeds").rows().size(), 4u * 2u * 2u); // directions, kd, waves
  return outcome.results;
}

Results nonlocal(const Subject &subject, std::initializer_list<std::size_t> stencils)
{
  NonlocalOptions options = parts::nonlocal_options(subject);
  const std::vector<NonlocalStencil> all = std::exchange(options.stencils, {});
  for (const std::size_t stencil : stencils)
    options.stencils.push_back(all.at(stencil));
  return nonlocal_claim(subject, options);
}

INSTANTIATE_TEST_SUITE_P(
  Claims, HeldClaim,
  testing::Values(std::pair("energy of waves", Check(energy_of_waves)), std::pair("wave-speeds", Check(wave_speeds)),
                  std::pair("prestretch", [](const Case &, const Subject &s) { return parts::prestretch.check(s); }),
                  std::pair("intrinsic-length",
                            [](const Case &, const Subject &s) { return parts::intrinsic_length.check(s); }),
                  // One stencil of each kind of points; NonlocalFault has all of them along the crack.
                  std::pair("nonlocal",
                            [](const Case &, const Subject &s) {
                              return nonlocal(s, {0, 5, 6});
                            })));

// Among them theory-comparison.md, eqs. (W.4) and (W.5), and theory-continuum.md, eq. (C.47) in finite elements.
TEST_P(HeldClaim, HoldsForBothShellSetsAcrossTheCrack)
{
  faults::expect_holds(GetParam().second);
}

// Free edges have no layer without next-nearest neighbours.
TEST(Claims, HoldForThreeShellsInBothOrientations)
{
  for (const auto &[orientation, has_next_nearest] :
       {std::pair(lattice::Orientation::rows_along_crack, true), {lattice::Orientation::rows_across_crack, false}})
  {
    Case input = subjects::with_third_shell(subjects::paper_case());
    input.orientation = orientation;
    input.has_next_nearest = has_next_nearest;
    const Subject three = subject(input);
    EXPECT_EQ(three.name, has_next_nearest ? "NN+NNN+3NN" : "NN+3NN");
    EXPECT_EQ(three.material.coordination(), has_next_nearest ? 18u : 12u);
    for (const Results &results :
         {contact_rows(three, input), parts::energy.check(three), parts::prestretch.check(three),
          parts::intrinsic_length.check(three), nonlocal(three, {0, 7})})
      EXPECT_TRUE(results.all_hold()) << results.verdict_text(5);
  }
}

const Result &row_with(const Results &results, const std::string &text)
{
  for (const Result &row : results.rows())
    if (row.quantity.find(text) != std::string::npos)
      return row;
  throw std::logic_error("no row has " + text);
}

Results checked(const std::string &claim, const Case &input)
{
  const std::vector<Claim> claims = commands::selected_claims({claim}, input.material());
  return run_claims(input, claims, true, Shells::own, laws_of_lattice()).results;
}

// Small strains, a stress that is zero along one axis, and shear, in which dashpots couple the two waves along an axis.
TEST(Claims, HoldInStatesWithLittleToCompare)
{
  Case input = subjects::paper_case();
  for (const auto &[x, y] : {std::pair(0., 0.), std::pair(1e-3, 0.), std::pair(0.01, 0.01), std::pair(-0.145692, 0.5)})
  {
    input.strain_x = x;
    input.strain_y = y;
    const Results results = parts::prestretch.check(subject(input));
    EXPECT_TRUE(results.all_hold()) << results.verdict_text(5);
  }
  input.shear = 0.2;
  EXPECT_TRUE(checked("wave-speeds", input).all_hold());
  // Polarisations in the middle between those of longitudinal and of shear waves, also of long waves alone, waves of
  // nearly one frequency, and slow ones: slower than all others by 3, and by 20 (of linear bonds).
  for (const auto &[shells, a, b, x, y] :
       {std::tuple(1, 0., 1e5, 0.8, 0.3), std::tuple(2, 0., 1e5, 2., 0.3), std::tuple(2, 1e5, 0., 0.3, 1.8),
        std::tuple(2, 1e5, 1e5, 0.3, 1.8), std::tuple(1, 1e5, 0., -0.15, 1.), std::tuple(1, 0., 0., -0.3, 0.03)})
  {
    using Law = latcon::input::ShellCase::Law;
    const Law law = a + b > 0. ? Law::mooney_rivlin : Law::linear;
    input = subjects::paper_case();
    input.has_next_nearest = shells == 2;
    input.nearest = {law, a, b, 1e5, 0.72, 65.625};
    input.next_nearest = {law, a, b, 1e5, 0.81, 196.875};
    input.strain_x = x;
    input.strain_y = y;
    const parts::States state{input.deformation()};
    const bool is_quick = a + b > 0. && x < 2.; // others take minutes
    const Results between =
      wave_speeds_claim(subject(input), parts::waves(state, is_quick ? state : parts::States())).results;
    EXPECT_TRUE(between.all_hold()) << between.verdict_text(5);
  }
  const Results energies = checked("energy", input); // of the last one
  EXPECT_TRUE(energies.all_hold()) << energies.verdict_text(5);
}

TEST(Claims, JudgeTheScatteredStencilOfTheCase)
{
  Case input = subjects::paper_case();
  input.nonlocal.scatter = 0.3;
  input.nonlocal.refinement = 1.7;
  const Results results = checked("nonlocal", input);
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(5);
  EXPECT_NO_THROW(row_with(results, "stencil of the case, force"));
}

// Which claims are checked without names, and before a crack of the lattice and of the continuum, for which materials.
TEST(Claims, AreThoseOfTheMaterial)
{
  Case plain = subjects::paper_case(), with_branches = plain, with_disorder = plain;
  with_branches.nearest.branch_moduli = {2e5};
  with_branches.nearest.relaxation_times = {2e-5};
  with_disorder.disorder.strength.kind = lattice::Distribution::Kind::weibull;
  const std::tuple<const char *, Case, bool> cases[] = {{"disorder", with_disorder, false},
                                                        {"relaxation", with_branches, true},
                                                        {"viscoelastic-waves", with_branches, true}};
  for (const auto &[name, input, is_before_fracture] : cases)
  {
    const Claim claim = commands::selected_claims({name}, input.material()).front();
    EXPECT_TRUE(claim.is_default_for(input.material())) << name;
    EXPECT_EQ(claim.is_before_fracture(input.material()), is_before_fracture) << name;
    EXPECT_FALSE(claim.is_default_for(plain.material())) << name;
    EXPECT_FALSE(claim.is_before_fracture(plain.material())) << name;
  }
  for (const bool on_continuum : {false, true})
  {
    const std::vector<Claim> claims = commands::claims_before_fracture(plain.material(), on_continuum);
    EXPECT_EQ(std::any_of(claims.begin(), claims.end(), [](const Claim &claim) { return claim.name == "nonlocal"; }),
              on_continuum);
  }
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

// The ratio of the constants of a bond is not that of the sheet.
TEST(Energy, FailsForTheRatioOfTheBondConstants)
{
  const Case input = subjects::paper_case();
  Subject wrong = subject(input);
  wrong.mooney_rivlin = with_ratio(input.lattice(), input.material(), input.deformation(), 0.6);
  EXPECT_EQ(faults::failing(energy_claim(wrong, 10), "calibrated ratio"), 1u);
  // As a choice of the user's it is nothing to judge.
  wrong.ratio_is_calibrated = false;
  EXPECT_EQ(row_with(energy_claim(wrong, 10), "given ratio r").verdict(), Verdict::reported);
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
