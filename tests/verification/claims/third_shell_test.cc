// Claims on lattices with third-nearest neighbours, and faults of these bonds that make claims fail.
#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"
#include "verification/claims/claim_inputs.h"

namespace claims_third_shell_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

Case with_third_shell(lattice::Orientation orientation = lattice::Orientation::rows_along_crack)
{
  Case input = subjects::paper_case();
  input.orientation = orientation;
  input.has_third_nearest = true;
  input.third_nearest = {ShellCase::Law::mooney_rivlin, 1e5, 1.5e5, 1., 2. / 3., 100.};
  return input;
}

// Free edges have no layer without next-nearest neighbours.
TEST(ThirdShell, ClaimsHoldInBothOrientations)
{
  for (const auto &[orientation, has_next_nearest] :
       {std::pair(lattice::Orientation::rows_along_crack, true), {lattice::Orientation::rows_across_crack, false}})
  {
    Case input = with_third_shell(orientation);
    input.has_next_nearest = has_next_nearest;
    const Subject three = subject(input);
    EXPECT_EQ(three.name, has_next_nearest ? "NN+NNN+3NN" : "NN+3NN");
    EXPECT_EQ(three.material.coordination(), has_next_nearest ? 18u : 12u);
    Results results = contact_rows(three, input);
    EXPECT_TRUE(results.all_hold()) << results.verdict_text(5);
    for (const parts::ClaimPart &part : {parts::energy, parts::prestretch, parts::intrinsic_length})
    {
      results = part.check(three);
      EXPECT_TRUE(results.all_hold()) << part << '\n' << results.verdict_text(5);
    }
  }
}

// The table after theory-comparison.md, eq. (W.2), with two digits more, and (C.26).
TEST(ThirdShell, HasTheKnownDispersionAndLength)
{
  const Case input = with_third_shell();
  const auto check = [&](double degrees, double longitudinal, double shear)
  {
    const Eigen::Vector2d N(std::cos(degrees * M_PI / 180.), std::sin(degrees * M_PI / 180.));
    const Alpha alpha = lattice_alpha(input.lattice(), input.material(), Eigen::Matrix2d::Identity(), N);
    EXPECT_NEAR(alpha[0], longitudinal, 5e-6);
    EXPECT_NEAR(alpha[1], shear, 5e-6);
  };
  check(0., 0.21392, 0.10825);
  check(30., 0.20275, 0.14175);
  const Subject three = subject(input);
  EXPECT_NEAR(three.lengths.lattice, input.spacing / std::sqrt(3.), 1e-15);
  EXPECT_NEAR(three.theory.shear_modulus, 2. / 3. * 9. / 8. * (3. + std::sqrt(3.)) * 2.5e5, 1e-3);
}

// Claims see the entries of the shell, and another lattice with other ones.
TEST(ThirdShell, IsAmongTheInputsOfClaims)
{
  Case input = with_third_shell();
  input.third_nearest.area_factor = 0.37;
  const Case read = claim_inputs(input);
  EXPECT_TRUE(read.has_third_nearest);
  EXPECT_EQ(read.third_nearest.area_factor, 0.37);
  EXPECT_EQ(read.material().third_nearest->viscosity, 100.);
  const std::string text = claim_inputs_text(input);
  input.third_nearest.viscosity = 101.;
  EXPECT_NE(claim_inputs_text(input), text);
  input.has_third_nearest = false;
  EXPECT_FALSE(claim_inputs(input).material().third_nearest);
}

} // namespace claims_third_shell_test
