// Means over rotations of a lattice, and bounds of the anisotropy that they omit.
#include "verification/bridge/homogeneous_response.h"

#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/largest_error.h"
#include "tests/verification/claims/subjects.h"
#include "verification/bridge/homogenisation.h"

namespace anisotropy_test
{

using namespace latcon;

using namespace bridge;
using namespace input;
using Values = std::function<Eigen::VectorXd(const Eigen::Matrix2d &R)>;

RotationMean over_rotations(const Values &values)
{
  Eigen::MatrixXd columns(values(lattice_rotation(0)).size(), n_lattice_rotations);
  for (int k = 0; k < n_lattice_rotations; ++k)
    columns.col(k) = values(lattice_rotation(k));
  return rotation_mean(columns);
}

// Rubber of quick.prm: s = 0.72, 0.81, and rows along x.
continuum::CauchyBorn quick_law()
{
  Case input = subjects::paper_case();
  input.nearest.area_factor = 0.72;
  input.next_nearest.area_factor = 0.81;
  return cauchy_born(input.lattice(), input.material());
}

// theory-comparison.md, eqs. (H.14) and (H.15): bounds relative to the values of the lattice, computed by an
// independent script from the Fourier coefficients of one bond of each shell. The energy attains its bound.
TEST(RotationMean, BoundsWhatTheNetworkLeavesOut)
{
  const continuum::CauchyBorn lattice = quick_law();
  const continuum::IsotropicNetwork network(lattice.families());
  struct Known
  {
    double x, y, energy, stress;
  };
  for (const auto &[x, y, energy, stress] :
       {Known{1.3, 1.1, 1.83e-3, 9.36e-3}, Known{1.5, 2., 3.98e-4, 3.39e-3}, Known{2.3, 2.8, 2.43e-7, 4.00e-5},
        Known{1., 2.8, 1.22e-2, 7.44e-2}, Known{1., 3.5, 9.79e-3, 7.83e-2}, Known{2.3, 1., 1.34e-2, 6.81e-2},
        Known{0.6, 2.8, 8.64e-2, 5.98e-1}})
  {
    SCOPED_TRACE(testing::Message() << "F = diag(" << x << ", " << y << ")");
    const Eigen::Matrix2d F = Eigen::Vector2d(x, y).asDiagonal();
    const Values energy_of = [&](const Eigen::Matrix2d &R)
    { return Eigen::VectorXd::Constant(1, lattice.energy(to_continuum(F * R))); };
    const Values stress_of = [&](const Eigen::Matrix2d &R)
    {
      const Eigen::Matrix2d P = to_lattice(lattice.first_piola_stress(to_continuum(F * R))) * R.transpose();
      return Eigen::VectorXd(P.reshaped());
    };
    const RotationMean W = over_rotations(energy_of), P = over_rotations(stress_of);
    const Eigen::VectorXd network_stress =
      Eigen::Matrix2d(to_lattice(network.first_piola_stress(to_continuum(F)))).reshaped();
    EXPECT_NEAR(W.mean(0) / network.energy(to_continuum(F)), 1., 1e-13);
    EXPECT_LT((P.mean - network_stress).norm(), 1e-13 * network_stress.norm());
    // Three digits are given.
    EXPECT_NEAR(W.bound / energy_of(lattice_rotation(0))(0) / energy, 1., 5e-3);
    EXPECT_NEAR(P.bound / stress_of(lattice_rotation(0)).norm() / stress, 1., 5e-3);

    double farthest_energy = 0., farthest_stress = 0.;
    for (int k = 0; k < 100; ++k) // of these angles only 0 is one of the rotations
    {
      const Eigen::Matrix2d R = Eigen::Rotation2Dd(M_PI / 3. * k / 100.).toRotationMatrix();
      farthest_energy = support::largest_of({farthest_energy, (energy_of(R) - W.mean).norm()});
      farthest_stress = support::largest_of({farthest_stress, (stress_of(R) - P.mean).norm()});
    }
    const double rounding = 1e-13;
    EXPECT_LE(farthest_energy, W.bound + rounding * W.mean.norm());
    EXPECT_GE(farthest_energy, 0.99 * W.bound);
    EXPECT_LE(farthest_stress, P.bound + rounding * P.mean.norm());
    EXPECT_GE(farthest_stress, 0.5 * P.bound);
  }
}

} // namespace anisotropy_test
