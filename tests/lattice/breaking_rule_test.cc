
#include <gtest/gtest.h>

#include "lattice/breaking_rule.h"
#include "tests/lattice/sheets.h"

namespace breaking_rule_test
{

using namespace latcon::lattice;

const Material rubber = sheets::rubber();

// A limit is never below what loops over rows flag, for any bond.
void expect_screened(const BreakingRule &rule, double weakest, double strongest)
{
  for (const double toughening : {1., 3.})
    for (const double strength : {weakest, 1., strongest})
      for (const double stiffness : {weakest, 1., strongest})
        for (const double rate : {-1e4, 0., 1e3})
          for (const std::size_t shell : {0u, 1u})
          {
            const double limit = rule.limit({shell, toughening, strength, stiffness, rate});
            EXPECT_GE(limit, rule.smallest_limit(toughening) * strength);
            EXPECT_LE(limit, rule.largest_limit(toughening) * strength);
          }
}

TEST(BreakingRule, IsScreenedBelowItsLimits)
{
  expect_screened(CriticalStretch(std::array<double, n_shells>{3., 3.5, 4.}), 0.5, 2.);
  expect_screened(CriticalStretch(3., 1.4, 1e-3), 0.5, 2.);
  Material disordered = rubber;
  disordered.disorder.strength = disordered.disorder.stiffness = Distribution(Distribution::Kind::uniform, 0.3);
  const Distribution &factors = disordered.disorder.strength;
  expect_screened(BondEnergy(disordered, 1e5), factors.smallest(), factors.largest());
}

TEST(BreakingRule, OfEnergyBreaksAtThatEnergy)
{
  const BondEnergy rule(rubber, energy(rubber.nearest.law, 2.5));
  EXPECT_DOUBLE_EQ(rule.limit({0}), 2.5);
  EXPECT_NEAR(energy(rubber.nearest.law, rule.limit({0, 3., 0.8, 1.2})), 2. * energy(rubber.nearest.law, 2.5), 1e-6);
  EXPECT_EQ(rule.limit({0, std::numeric_limits<double>::infinity()}), std::numeric_limits<double>::infinity());
}

TEST(BreakingRule, OfRateToughensBondsThatStretchFast)
{
  const CriticalStretch rule(3., 1.5, 1e-3);
  EXPECT_EQ(rule.limit({0, 1., 1., 1., -1e6}), 3.);
  EXPECT_DOUBLE_EQ(rule.limit({0, 1., 1., 1., 1e3}), 3. * 1.25);
  EXPECT_NEAR(rule.limit({1, 2., 1., 1., 1e12}), 9., 1e-6);
}

// In a sheet at one stretch in motion, the bonds that break are those beyond their own limit, with long steps and
// short.
TEST(Fracture, AsksTheRuleAboutEachBond)
{
  const TriangularLattice sheet = sheets::square(12);
  const Eigen::Matrix2d F = sheets::stretched(1.5, 1.5), L = sheets::stretched(100., 100.);
  const auto broken =
    [&](const TimeStepping &how, std::shared_ptr<const BreakingRule> rule, const Eigen::Matrix2d &rate)
  {
    Simulation simulation(sheet, rubber, homogeneous_state(sheet, rubber, F, Edges::held), how,
                          Fracture(sheet, rubber, std::move(rule), Toughening{}, F));
    VectorField velocity(sheet.n_places());
    for (const std::size_t place : sheet.sites())
      velocity.set(place, rate * sheet.reference(place));
    simulation.set_velocities(velocity);
    simulation.constrain({held_sites(simulation.state(), sheet), true, true, steady(rate)});
    std::size_t near = 0, next = 0;
    for (const BrokenBond &bond : simulation.step())
      ++(bond.kind < n_kinds_per_shell ? near : next);
    return std::pair(near, next);
  };
  const Eigen::Matrix2d still = Eigen::Matrix2d::Zero();
  for (const TimeStepping &how : {TimeStepping{1e-9}, TimeStepping{1e-8, 3}})
  {
    const auto [near, next] =
      broken(how, std::make_shared<CriticalStretch>(std::array<double, n_shells>{2., 1.4, 2.}), still);
    EXPECT_EQ(near, 0u);
    EXPECT_GT(next, 0u);
    EXPECT_GT(broken(how, std::make_shared<CriticalStretch>(1.4, 1.2, 1.), still).first, 0u);
    EXPECT_EQ(broken(how, std::make_shared<CriticalStretch>(1.4, 1.2, 1.), L).first, 0u);
    EXPECT_GT(broken(how, std::make_shared<BondEnergy>(rubber, energy(rubber.nearest.law, 1.45)), still).first, 0u);
    EXPECT_EQ(broken(how, std::make_shared<BondEnergy>(rubber, energy(rubber.nearest.law, 1.6)), still).first, 0u);
  }
}

} // namespace breaking_rule_test
