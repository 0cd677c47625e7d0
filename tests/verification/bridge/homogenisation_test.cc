#include "verification/bridge/homogenisation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/verification/claims/subjects.h"
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

namespace homogenisation_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;

// Evaluated independently: theory-comparison.md, eqs. (H.1) to (H.3). The law of the continuum has the shear modulus as
// both of its Lame constants.
TEST(Homogenisation, HasTheKnownSmallStrainConstants)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
  {
    Case input = subjects::paper_case();
    input.orientation = orientation;
    const SmallStrain both = small_strain(input.lattice(), input.material());
    EXPECT_NEAR(both.shear_modulus / 2.5e5, 2.049038, 5e-7);
    EXPECT_NEAR(both.shear_speed, 23.29480, 5e-6);
    EXPECT_NEAR(both.longitudinal_speed, 40.34778, 5e-6);
    const SmallStrain nearest = small_strain(input.lattice(), subjects::nearest_only(input));
    EXPECT_NEAR(nearest.shear_speed, 14.09336, 5e-6);
    EXPECT_NEAR(nearest.longitudinal_speed, 24.41042, 5e-6);
    const auto tangent =
      cauchy_born(input.lattice(), input.material()).tangent(to_continuum(Eigen::Matrix2d::Identity()));
    for (const double component : {tangent[0][0][0][0] / 3., tangent[0][0][1][1], tangent[0][1][0][1]})
      EXPECT_NEAR(component, both.shear_modulus, 1e-13 * both.shear_modulus * 10.);
  }
}

// The mean over all directions of alpha d^2 of the lattice, (W.2), is l_d^2 - l_s^2 M / (rho c^2) with the modulus M =
// mu of the isotropic gradient energy: theory-comparison.md, eqs. (H.7) and (H.8).
TEST(GradientLengths, OfTheIsotropicLawAverageTheDispersionOfTheLattice)
{
  const Case input = subjects::paper_case();
  for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
  {
    const GradientLengths lengths = gradient_lengths(input.lattice(), material);
    // Averages over equal steps are exact for harmonics up to the sixth.
    constexpr int steps = 24;
    double longitudinal = 0., shear = 0.;
    for (int i = 0; i < steps; ++i)
    {
      const double angle = 2. * M_PI * i / steps;
      const Alpha alpha =
        lattice_alpha(input.lattice(), material, Eigen::Matrix2d::Identity(), {std::cos(angle), std::sin(angle)});
      longitudinal += alpha[0] / steps;
      shear += alpha[1] / steps;
    }
    const double unit = input.spacing * input.spacing;
    const double l_s2 = std::pow(lengths.isotropic_static, 2) / unit,
                 l_d2 = std::pow(lengths.isotropic_inertia, 2) / unit;
    EXPECT_NEAR(longitudinal, l_d2 - l_s2 / 3., 1e-13); // rho c^2 = 3 mu
    EXPECT_NEAR(shear, l_d2 - l_s2, 1e-13);
  }
}

// theory-comparison.md, eqs. (H.4) and (H.5).
TEST(Calibration, IsTheBestRatioOnThePath)
{
  const Case input = subjects::paper_case();
  const auto sheet = input.lattice();
  const auto F = input.deformation();
  const Calibration best = calibrate_mooney_rivlin(sheet, input.material(), F);
  EXPECT_GT(best.energy_residual, 1e-3); // the laws differ for every ratio
  EXPECT_LT(best.energy_residual, 0.07); // as stated in theory.md
  EXPECT_GT(best.smallest_acoustic_eigenvalue, 0.);
  for (const double offset : {-0.02, -1e-3, 1e-3, 0.02})
    EXPECT_GT(with_ratio(sheet, input.material(), F, best.ratio + offset).energy_residual, best.energy_residual)
      << offset;
}

} // namespace homogenisation_test
