// Cracks that run: symmetry and energy.
#include <algorithm>
#include <cmath>
#include <memory>

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
  explicit Crack(Orientation orientation, double noise, double time_step_factor = 0.9, double n = 40.)
    : sheet(sheets::spacing, 1.5 * n * sheets::spacing, n * sheets::spacing, orientation), material(sheets::rubber())
  {
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
    State state = homogeneous_state(sheet, material, F, Edges::held);
    add_noise(state, sheet, noise * sheets::spacing, 1);
    simulation = std::make_unique<Simulation>(
      sheet, material, std::move(state), time_step_factor * time_step_limits(sheet, material, 0.3).combined,
      Fracture(sheet, material, 3.05, BehindTipToughening{8. * sheets::spacing, 1000.}, F));
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

// Without noise the crack and its mirror image are one: positions agree to the last bit, bonds break in pairs.
class SymmetricSeed : public testing::TestWithParam<Orientation>
{
};
INSTANTIATE_TEST_SUITE_P(Fracture, SymmetricSeed,
                         testing::Values(Orientation::rows_along_crack, Orientation::rows_across_crack));
TEST_P(SymmetricSeed, StaysSymmetricToTheLastBit)
{
  Crack crack(GetParam(), 0.);
  std::size_t broken = 0;
  double lowest = 0., highest = 0.;
  for (int step = 0; step < 4000; ++step)
    for (const BrokenBond &bond : crack.simulation->step())
    {
      ++broken;
      lowest = std::min(lowest, bond.midpoint.y());
      highest = std::max(highest, bond.midpoint.y());
    }
  EXPECT_GT(broken, 100u);
  EXPECT_EQ(lowest, -highest);
  const TriangularLattice &sheet = crack.sheet;
  const bool along = GetParam() == Orientation::rows_along_crack;
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      const std::size_t mirror =
        along ? sheet.index(sheet.rows() - 1 - row, column) : sheet.index(row, sheet.sites_in_row(row) - 1 - column);
      ASSERT_EQ(crack.simulation->state().x[place], crack.simulation->state().x[mirror]);
      ASSERT_EQ(crack.simulation->state().y[place], -crack.simulation->state().y[mirror]);
    }
}

// Energy ledger through a running crack: what the springs lost is in motion, in the dashpots or in broken bonds.
// theory.md, eq. (L.11).
TEST(EnergyBalance, ClosesThroughFracture)
{
  Crack crack(Orientation::rows_along_crack, 0.01, 0.5);
  for (int step = 0; step < 6000; ++step)
    crack.simulation->step();
  const EnergyBalance e = crack.simulation->energies();
  EXPECT_GT(crack.simulation->n_broken(), 100u);
  EXPECT_GT(e.viscous, 1e-3 * e.initial);
  EXPECT_GT(e.broken, 1e-3 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-6 * e.initial);
}

} // namespace crack_test
