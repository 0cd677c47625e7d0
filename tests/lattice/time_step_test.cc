#include "lattice/time_step.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "lattice/contact.h"
#include "lattice/simulation.h"
#include "support/largest_error.h"
#include "tests/lattice/plane_modes.h"
#include "tests/lattice/sheets.h"

namespace time_step_test
{

using namespace latcon;
using namespace lattice;

constexpr double modulus = 2e5;

// Says that it is four times as stiff as it is.
struct StiffBond : LinearBond
{
  using LinearBond::LinearBond;
  double largest_stiffness(double) const { return 4. * modulus; }
};

// What a change of linear bonds between nearest neighbours multiplies: omega^2 and gamma of theory.md, eqs. (L.8) to
// (L.10), and kappa of eq. (L.22).
struct Change
{
  const char *what;
  std::function<void(Material &)> change;
  double omega_2, gamma, kappa;
  double contact_stiffness = 0., contact_viscosity = 1.; // in those of a bond
};

// theory.md, eq. (L.14) for contacts.
TEST(TimeStepLimits, CountAllSpringsAndDashpots)
{
  const TriangularLattice sheet = sheets::square(12);
  Material plain = sheets::nearest_only(1e-3);
  plain.nearest.law = LinearBond{modulus};
  const TimeStepLimits limits = time_step_limits(sheet, plain, 0.5);
  // By hand: omega^2 = 12 A0 E / (d m), A0 / m = s / (rho d).
  EXPECT_NEAR(limits.elastic, 2. / std::sqrt(12. * 2. / 3. * modulus / (944. * sheets::spacing * sheets::spacing)),
              1e-12 * limits.elastic);
  EXPECT_DOUBLE_EQ(limits.viscous, 944. * std::pow(sheets::spacing, 2) / (12. * 2. / 3. * 1e-3));
  EXPECT_DOUBLE_EQ(chebyshev_step(sheet, plain, 0.5), 1e-3 / modulus);
  const Distribution wide(Distribution::Kind::normal, 0.2);
  const Change changes[] = {
    {"branches",
     [](Material &m) {
       m.nearest.memory = MaxwellMemory({{4e5, 1e-4}, {2e5, 1e-3}});
     },
     4., 1., 4.},
    {"law from outside", [](Material &m) { m.nearest.law = sheets::from_outside(StiffBond(modulus)); }, 4., 1., 4.},
    {"disorder of the stiffness", [&](Material &m) { m.disorder.stiffness = wide; }, wide.largest(), wide.largest(),
     1.},
    {"disorder of the strength", [&](Material &m) { m.disorder.strength = wide; }, 1., 1., 1.},
    // Of half the inverse length.
    {"third-nearest neighbours", [](Material &m) { m.third_nearest = m.nearest; }, 1.5, 1.5, 1.},
    // Six for six of the twelve ends of bonds at a site: those as of bonds leave the step alone.
    {"contacts", [](Material &) {}, 1., 1., 1., 1.},
    {"soft contacts", [](Material &) {}, 1., 1., 1., 0.5, 0.5},
    {"stiff contacts", [](Material &) {}, 2., 1., 1., 3.},
    {"viscous contacts", [](Material &) {}, 1., 2., 1., 1., 3.}};
  for (const Change &own : changes)
  {
    SCOPED_TRACE(own.what);
    Material material = plain;
    own.change(material);
    const bool touches = own.contact_stiffness > 0.;
    const TimeStepLimits found =
      touches ? time_step_limits(sheet, material, 0.5,
                                 contact_like_nearest_bond(sheet, material, sheets::spacing, own.contact_stiffness,
                                                           own.contact_viscosity))
              : time_step_limits(sheet, material, 0.5);
    EXPECT_NEAR(found.elastic * std::sqrt(own.omega_2) / limits.elastic, 1., 1e-14);
    EXPECT_NEAR(found.viscous * own.gamma / limits.viscous, 1., 1e-14);
    EXPECT_NEAR(found.combined / found.viscous + std::pow(found.combined / found.elastic, 2), 1., 1e-14);
    EXPECT_NEAR(chebyshev_step(sheet, material, 0.5) * own.kappa * modulus / 1e-3, 1., 1e-14);
  }
  const TimeStepLimits springs = time_step_limits(sheet, sheets::nearest_only(0.), 1.);
  EXPECT_TRUE(std::isinf(springs.viscous));
  EXPECT_DOUBLE_EQ(springs.combined, springs.elastic);
}

// The largest frequency of all plane waves against the bound, whose phases are those of bonds up to 2 d long.
TEST(TimeStepLimits, ExceedTheFrequenciesOfPlaneWaves)
{
  const Material undamped = sheets::rubber_of_three_shells(0.);
  const TriangularLattice sheet = sheets::square(8);
  double fastest = 0.;
  for (const std::complex<double> &rate : plane_modes::rates(sheet, undamped, Eigen::Matrix2d::Identity()))
    fastest = support::largest_of({fastest, std::abs(rate.imag())});
  const double limit = time_step_limits(sheet, undamped, 1.).elastic;
  EXPECT_LT(limit, 2. / fastest);
  EXPECT_GT(limit, 0.5 * 2. / fastest); // and not far below
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

} // namespace time_step_test
