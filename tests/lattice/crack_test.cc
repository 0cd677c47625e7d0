// Cracks that run: symmetry, energy and contact.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "lattice/fracture.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

namespace crack_test
{

using namespace latcon;

using namespace lattice;

struct Crack
{
  Crack(Orientation orientation, Material bonds, double time_step_factor = 0.5,
        const Toughening &toughening = BehindTipToughening{8. * sheets::spacing, 1000.}, double noise = 0.)
    : sheet(sheets::spacing, 60. * sheets::spacing, 40. * sheets::spacing, orientation), material(std::move(bonds))
  {
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
    State state = homogeneous_state(sheet, material, F, Edges::held);
    add_noise(state, sheet, noise * sheets::spacing, 1);
    simulation = std::make_unique<Simulation>(sheet, material, std::move(state),
                                              time_step_factor * time_step_limits(sheet, material, 0.3).combined,
                                              Fracture(sheet, material, 3.05, toughening, F));
    // A slit on the line y = 0: along a row, or one site of every second row.
    std::vector<std::size_t> seed;
    if (orientation == Orientation::rows_along_crack)
      seed = sheets::middle_row(sheet, 6, 8);
    else
      for (std::size_t row = 6; row < 14; row += 2)
        seed.push_back(sheet.index(row, sheet.columns() / 2));
    simulation->cut(seed);
  }
  TriangularLattice sheet;
  Material material;
  std::unique_ptr<Simulation> simulation;
};

class SymmetricSeed : public testing::TestWithParam<std::pair<Orientation, Material>>
{
};
INSTANTIATE_TEST_SUITE_P(Fracture, SymmetricSeed,
                         testing::Values(std::pair(Orientation::rows_along_crack, sheets::rubber()),
                                         std::pair(Orientation::rows_across_crack, sheets::rubber()),
                                         std::pair(Orientation::rows_along_crack, sheets::rubber_of_three_shells())));

// Without noise the crack and its mirror image are one: positions agree to the last bit, bonds break in pairs. What the
// springs lost is in motion, in the dashpots or in broken bonds. theory.md, eq. (L.11).
TEST_P(SymmetricSeed, StaysSymmetricToTheLastBitAndItsLedgerCloses)
{
  const auto &[orientation, material] = GetParam();
  Crack crack(orientation, material);
  std::map<std::size_t, std::size_t> broken; // by shell
  double lowest = 0., highest = 0.;
  for (int step = 0; step < 6000; ++step)
    for (const BrokenBond &bond : crack.simulation->step())
    {
      ++broken[shell_of(bond.kind)];
      lowest = std::min(lowest, bond.midpoint.y());
      highest = std::max(highest, bond.midpoint.y());
    }
  EXPECT_EQ(broken.size(), material.third_nearest ? 3u : 2u);
  for (const auto &[shell, n] : broken)
    EXPECT_GT(n, 40u) << shell;
  EXPECT_EQ(lowest, -highest);
  for (const std::size_t place : sheets::sites(crack.sheet))
  {
    const std::size_t mirror = sheets::mirrored(crack.sheet, place);
    ASSERT_EQ(crack.simulation->state().x[place], crack.simulation->state().x[mirror]);
    ASSERT_EQ(crack.simulation->state().y[place], -crack.simulation->state().y[mirror]);
  }
  const EnergyBalance e = crack.simulation->energies();
  EXPECT_GT(e.viscous, 1e-3 * e.initial);
  EXPECT_GT(e.broken, 1e-3 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-6 * e.initial);
}

// Flanks and debris touch in a crack without toughening.
TEST(Contact, LedgerClosesThroughACrackWhoseDebrisTouches)
{
  Crack crack(Orientation::rows_along_crack, sheets::rubber(), 0.9, NoToughening{}, 0.05);
  Simulation &simulation = *crack.simulation;
  simulation.enable_contact(contact_like_nearest_bond(crack.sheet, crack.material, sheets::spacing, 1., 1.));
  std::size_t most = 0;
  for (int step = 0; step < 6000; ++step)
  {
    simulation.step();
    most = std::max(most, simulation.contact()->n_touching());
  }
  EXPECT_GT(most, 5u);
  const EnergyBalance e = simulation.energies();
  EXPECT_GT(e.contact, 1e-4 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-4 * e.initial);
}

} // namespace crack_test
