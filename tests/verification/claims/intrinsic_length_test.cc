// The intrinsic length of the bonds, and faults that make its claim fail.
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"

namespace intrinsic_length_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

Eigen::Vector2d direction(double degrees)
{
  return {std::cos(degrees * M_PI / 180.), std::sin(degrees * M_PI / 180.)};
}

// The table after theory-comparison.md, eq. (W.2), with one or two digits more.
TEST(Dispersion, HasTheKnownCoefficients)
{
  const Case input = subjects::paper_case(), three = subjects::with_third_shell(input);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const auto check =
    [&](const lattice::Material &material, double degrees, double longitudinal, double shear, double digits)
  {
    const Alpha alpha = lattice_alpha(input.lattice(), material, I, direction(degrees));
    EXPECT_NEAR(alpha[0], longitudinal, digits);
    EXPECT_NEAR(alpha[1], shear, digits);
    const Alpha bloch = bloch_alpha(input.lattice(), material, I, direction(degrees));
    EXPECT_NEAR(bloch[0], alpha[0], 1e-7);
    EXPECT_NEAR(bloch[1], alpha[1], 1e-7);
  };
  check(subjects::nearest_only(input), 0., 11. / 144., 1. / 48., 1e-14);
  check(subjects::nearest_only(input), 30., 1. / 16., 1. / 16., 1e-14);
  check(subjects::nearest_only(input), 90., 1. / 16., 1. / 16., 1e-14);
  check(input.material(), 0., 0.1468305, 0.1264958, 5e-8);
  check(input.material(), 90., 0.1681624, 0.0625, 5e-8);
  check(three.material(), 0., 0.21392, 0.10825, 5e-6);
  check(three.material(), 30., 0.20275, 0.14175, 5e-6);
}

// theory-comparison.md, eq. (C.26).
TEST(Lengths, AreThoseOfThreeShells)
{
  const Case input = subjects::with_third_shell(subjects::paper_case());
  const Subject three = subject(input);
  EXPECT_NEAR(three.lengths.lattice, input.spacing / std::sqrt(3.), 1e-15);
  EXPECT_NEAR(three.theory.shear_modulus, 2. / 3. * 9. / 8. * (3. + std::sqrt(3.)) * 2.5e5, 1e-3);
}

// theory-comparison.md, eq. (W.6), and the numbers after it.
TEST(EdgeLayer, HasTheKnownDeviationAndDecay)
{
  const Case input = subjects::paper_case();
  const EdgeLayer layer = relaxed_edge(input.spacing, input.material(), 1.05, 8);
  EXPECT_NEAR(layer.deviations[0], -8.67e-3, 5e-6);
  EXPECT_NEAR(edge_decay(input.spacing, input.material(), 1.05, layer.stretch_across), -0.2177, 5e-5);
  const lattice::Material nearest = subjects::nearest_only(input);
  EXPECT_EQ(edge_decay(input.spacing, nearest, 1.05, relaxed_edge(input.spacing, nearest, 1.05, 8).stretch_across), 0.);
}

// theory-continuum.md, eq. (C.26).
TEST(GradientPositivity, IsLostBelowTheCriticalLengthAndNotAboveIt)
{
  const Case input = subjects::paper_case();
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
  {
    const double critical = critical_length(input.lattice(), material, I).value();
    EXPECT_LT(smallest_lattice_eigenvalue(input.lattice(), material, I, 0.999 * critical), 0.);
    EXPECT_GT(smallest_lattice_eigenvalue(input.lattice(), material, I, 1.001 * critical), 0.);
  }
  // Nearest neighbours alone need all of d / sqrt(12); together with the next-nearest, less than d / 2 will do.
  EXPECT_NEAR(critical_length(input.lattice(), subjects::nearest_only(input), I).value(),
              input.spacing / std::sqrt(12.), 1e-12 * input.spacing);
  EXPECT_LT(critical_length(input.lattice(), input.material(), I).value(), 0.44 * input.spacing);
}

// Bonds that are compressed push sideways: gradients across them have a negative energy, however long l_d.
TEST(GradientPositivity, HasNoLengthWhereBondsAreCompressed)
{
  const Case input = subjects::paper_case();
  const Eigen::Matrix2d compressed = Eigen::Vector2d(0.7, 1.).asDiagonal();
  EXPECT_FALSE(critical_length(input.lattice(), subjects::nearest_only(input), compressed).has_value());
  EXPECT_LT(smallest_lattice_eigenvalue(input.lattice(), subjects::nearest_only(input), compressed, input.spacing), 0.);

  Subject subject = bridge::subject(input, subjects::nearest_only(input));
  subject.deformation = compressed;
  const Results results = parts::intrinsic_length.check(subject);
  EXPECT_EQ(faults::failing(results), 0u);
  std::size_t n_reported = 0;
  for (const Result &row : results.rows())
  {
    EXPECT_EQ(row.quantity.find("1 % below the shortest length: negative, loaded"), std::string::npos);
    n_reported += row.quantity.find("loaded: there is none, bonds are compressed") != std::string::npos &&
                      row.verdict() == Verdict::reported
                    ? 1
                    : 0;
  }
  EXPECT_EQ(n_reported, 1u);
}

} // namespace intrinsic_length_test
