#include "lattice/velocity_verlet.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/sheets.h"
#include "tests/lattice/smooth_motion.h"

namespace velocity_verlet_test
{

using namespace latcon;

using namespace lattice;
using smooth_motion::distance;
using smooth_motion::run;

// Order from three halvings: |x_h - x_(h/2)| / |x_(h/2) - x_(h/4)| = 2^order, no exact solution needed.
double observed_order(const Material &material, double time_step, std::size_t steps)
{
  const State coarse = run(material, time_step, steps);
  const State medium = run(material, time_step / 2., 2 * steps);
  const State fine = run(material, time_step / 4., 4 * steps);
  return std::log2(distance(coarse, medium) / distance(medium, fine));
}

TEST(VelocityVerlet, ConvergesAtSecondOrder)
{
  EXPECT_NEAR(observed_order(sheets::rubber(0.), 4e-7, 200), 2., 0.1);
}

// theory.md, eq. (L.7).
TEST(VelocityVerlet, ConvergesAtSecondOrderWithDashpots)
{
  // A quarter of the stable step: there the stiffest modes have come into the asymptotic range.
  const double limit = time_step_limits(sheets::square(12), sheets::rubber(), 0.5).viscous;
  EXPECT_NEAR(observed_order(sheets::rubber(), 0.25 * limit, 400), 2., 0.1);
}

// One bond's dashpot between two free sites: v_rel' = -2 (c/m) v_rel exactly, so the scheme's own recursion is known:
// its two roots for z = gamma h solve r^2 - (1 - 3z/2) r - z/2 = 0, and it diverges beyond z = 1.
// theory.md, eq. (L.8).
TEST(VelocityVerlet, DampingLimitOfOneDashpotIsOne)
{
  const TriangularLattice sheet = sheets::square(6);
  Material material = sheets::nearest_only();
  material.nearest.law = LinearBond{1e-9}; // springs out of the way
  const double mass = site_mass(material, sheet);
  const double gamma =
    2. * cross_section(material.nearest, sheet) * material.nearest.viscosity / (sheets::spacing * mass);
  const auto relative_velocity_after = [&](double z, int steps)
  {
    State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free);
    const std::size_t left = sheet.index(3, 2);
    state.bonds.clear(sheet.n_places());
    state.bonds.add(left, 0);
    state.vx[left] = -1e-6;
    state.vx[left + 1] = 1e-6;
    Forces forces(sheet, material);
    VelocityVerlet verlet(sheet, forces, z / gamma);
    verlet.initialise(state);
    for (int step = 0; step < steps; ++step)
      verlet.step(state);
    return std::abs(state.vx[left + 1] - state.vx[left]) / 2e-6;
  };
  EXPECT_LT(relative_velocity_after(0.99, 2000), 1.);
  EXPECT_GT(relative_velocity_after(1.01, 2000), 1.);
  // z = 1/2: largest root (1/4 + sqrt(1/16 + 1)) / 2.
  const double root = (0.25 + std::sqrt(1.0625)) / 2.;
  EXPECT_NEAR(relative_velocity_after(0.5, 21) / relative_velocity_after(0.5, 20), root, 1e-4);
}

// In the undeformed lattice of nearest neighbours the shortest waves attain gamma = 6 c / m, half the stated bound, so
// a sheet is stable up to twice the stated limit and not beyond. The held edge costs a finite sheet a few percent.
// theory.md, eqs. (L.9) and (L.10).
TEST(TimeStepLimits, AreSafeAndSharp)
{
  const Material material = sheets::nearest_only();
  const TriangularLattice sheet = sheets::square(40);
  const TimeStepLimits limits = time_step_limits(sheet, material, 1.);
  const auto growth = [&](double factor)
  {
    State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
    add_noise(state, sheet, 1e-3 * sheets::spacing, 5);
    Simulation simulation(sheet, material, std::move(state), factor * limits.combined);
    for (int step = 0; step < 3000; ++step)
      simulation.step();
    const EnergyBalance energies = simulation.energies();
    return energies.kinetic / energies.initial;
  };
  EXPECT_LT(growth(1.), 1.);
  EXPECT_LT(growth(1.95), 1.);
  EXPECT_FALSE(growth(2.1) < 1.); // beyond, or no number any more
}

TEST(TimeStepLimits, AreThatOfTheSpringsAlone)
{
  const Material material = sheets::nearest_only(0.);
  const TriangularLattice sheet = sheets::square(40);
  const TimeStepLimits limits = time_step_limits(sheet, material, 1.);
  EXPECT_TRUE(std::isinf(limits.viscous));
  EXPECT_DOUBLE_EQ(limits.combined, limits.elastic);
  // By hand: omega^2 = 12 A0 3 (a + b) / (d m), A0 / m = s / (rho d).
  EXPECT_NEAR(limits.elastic, 2. / std::sqrt(12. * 2. / 3. * 7.5e5 / (944. * sheets::spacing * sheets::spacing)),
              1e-12 * limits.elastic);
}

TEST(Noise, DependsOnSeedAloneAndKeepsItsAmplitude)
{
  const TriangularLattice sheet = sheets::square(30);
  const Material material = sheets::rubber();
  const State still = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  State a = still, b = still, c = still;
  add_noise(a, sheet, 1e-5, 7);
  add_noise(b, sheet, 1e-5, 7);
  add_noise(c, sheet, 1e-5, 8);
  EXPECT_EQ(a.x, b.x);
  EXPECT_NE(a.x, c.x);
  double largest = 0., sum = 0., square = 0.;
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    if (still.inverse_mass[i] > 0.)
      for (const double u : {a.x[i] - still.x[i], a.y[i] - still.y[i]})
      {
        largest = support::largest_of({largest, std::abs(u)});
        sum += u;
        square += u * u;
        ++n;
      }
    else
      EXPECT_EQ(a.x[i], still.x[i]);
  // Uniform on [-A, A]: mean 0 +- A / sqrt(3n), mean square A^2 / 3; three standard deviations.
  EXPECT_LE(largest, 1e-5 * (1. + 1e-9));
  EXPECT_NEAR(sum / n, 0., 3. * 1e-5 / std::sqrt(3. * n));
  EXPECT_NEAR(square / n / 1e-10, 1. / 3., 3. * std::sqrt(4. / 45. / n));
}

} // namespace velocity_verlet_test
