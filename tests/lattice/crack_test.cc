// Cracks that run: symmetry, energy and contact.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "tests/lattice/running_crack.h"

namespace crack_test
{

using namespace latcon;

using namespace lattice;

TriangularLattice sheet_of(Orientation orientation)
{
  return {sheets::spacing, 60. * sheets::spacing, 40. * sheets::spacing, orientation};
}

using SymmetricSeed = testing::TestWithParam<std::pair<Orientation, Material>>;
INSTANTIATE_TEST_SUITE_P(Fracture, SymmetricSeed,
                         testing::Values(std::pair(Orientation::rows_along_crack, sheets::rubber()),
                                         std::pair(Orientation::rows_across_crack, sheets::rubber()),
                                         std::pair(Orientation::rows_along_crack, sheets::rubber_of_three_shells())));

// Without noise the crack and its mirror image are one: positions agree to the last bit, bonds break in pairs. What the
// springs lost is in motion, in the dashpots or in broken bonds. theory.md, eq. (L.11).
TEST_P(SymmetricSeed, StaysSymmetricToTheLastBitAndItsLedgerCloses)
{
  const auto &[orientation, material] = GetParam();
  const TriangularLattice sheet = sheet_of(orientation);
  running_crack::Choice choice;
  choice.material = material;
  choice.stepping = 0.5 * time_step_limits(sheet, material, 0.3).combined;
  choice.toughening = Toughening{1000., 0., 8. * sheets::spacing};
  choice.noise = 0.;
  const auto crack = running_crack::start(sheet, choice);
  std::map<std::size_t, std::size_t> broken; // by shell
  double lowest = 0., highest = 0.;
  for (int step = 0; step < 6000; ++step)
    for (const BrokenBond &bond : crack->step())
    {
      ++broken[shell_of(bond.kind)];
      lowest = std::min(lowest, bond.Y);
      highest = std::max(highest, bond.Y);
    }
  EXPECT_EQ(broken.size(), material.third_nearest ? 3u : 2u);
  for (const auto &[shell, n] : broken)
    EXPECT_GT(n, 40u) << shell;
  EXPECT_EQ(lowest, -highest);
  for (const std::size_t place : sheet.sites())
  {
    const std::size_t mirror = sheets::mirrored(sheet, place);
    ASSERT_EQ(crack->state().position.x[place], crack->state().position.x[mirror]);
    ASSERT_EQ(crack->state().position.y[place], -crack->state().position.y[mirror]);
  }
  const EnergyBalance e = crack->energies();
  EXPECT_GT(e.viscous, 1e-3 * e.initial);
  EXPECT_GT(e.broken, 1e-3 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-6 * e.initial);
}

// Flanks and debris touch in a crack without toughening.
TEST(Contact, LedgerClosesThroughACrackWhoseDebrisTouches)
{
  const TriangularLattice sheet = sheet_of(Orientation::rows_along_crack);
  running_crack::Choice choice;
  choice.stepping = 0.9 * time_step_limits(sheet, choice.material, 0.3).combined;
  choice.toughening = Toughening{};
  choice.contact = choice.contact_strength = 1.;
  const auto crack = running_crack::start(sheet, choice);
  std::size_t most = 0;
  for (int step = 0; step < 6000; ++step)
  {
    crack->step();
    most = std::max(most, crack->contact()->last().size());
  }
  EXPECT_GT(most, 10u);
  const EnergyBalance e = crack->energies();
  EXPECT_GT(e.contact, 1e-4 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-4 * e.initial);
}

} // namespace crack_test
