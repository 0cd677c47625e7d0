#include "lattice/constraint.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/largest_error.h"
#include "tests/lattice/sheets.h"

namespace constraint_test
{

using namespace latcon::lattice;

const Eigen::Matrix2d start = sheets::stretched(1.2, 1.4), low = sheets::stretched(1.2, 1.25);

class Constraints : public testing::TestWithParam<bool>
{
protected:
  // Pieces end within steps.
  static constexpr double first = 8.0304e-5, second = 12.1007e-5, third = 20.9003e-5;

  const TriangularLattice sheet{sheets::square(20)};
  const Material material{sheets::rubber()};
  const TimeStepping stepping = GetParam() ? TimeStepping{5e-7, 4} : TimeStepping{2.5e-8};
  const Constraint::Motion history = piecewise_linear({0., first, second, third}, {start, low, low, start});

  Simulation simulation(Edges edges) const
  {
    return {sheet, material, homogeneous_state(sheet, material, start, edges), stepping};
  }
  static void expect_closed_ledger(const Simulation &moved)
  {
    const EnergyBalance e = moved.energies();
    EXPECT_GT(e.viscous, 0.);
    EXPECT_LT(std::abs(e.imbalance()), 2e-3 * (std::abs(e.boundary_work) + e.viscous + e.kinetic));
  }
};

TEST_P(Constraints, FollowAHistoryAndItsWorkIsCounted)
{
  Simulation moved = simulation(Edges::held);
  const std::vector<std::size_t> held = held_sites(moved.state(), sheet);
  moved.constrain({held, true, true, history});
  const auto expect_at = [&](double time, const Eigen::Matrix2d &F)
  {
    while (moved.state().time < time)
      moved.step();
    for (const std::size_t place : held)
    {
      const Eigen::Vector2d x = moved.state().position.at(place);
      EXPECT_LT((x - F * sheet.reference(place)).norm(), 1e-12 * sheet.length());
    }
  };
  expect_at(0.5 * (first + second), low);
  expect_at(1.1 * third, start);
  expect_closed_ledger(moved);
  EXPECT_EQ(moved.energies().boundary_work, moved.constraint_work(0));
}

// The upper and lower edges slide along x, as the sides draw in.
TEST_P(Constraints, RollersSlideAlongOneAxis)
{
  const Edges ends{false, false, true, true};
  Simulation moved = simulation(Edges::free);
  const std::vector<std::size_t> rolling = sites_at(sheet, material, ends);
  moved.constrain({rolling, false, true, history});
  while (moved.state().time < 0.5 * (first + second))
    moved.step();
  double slid = 0.;
  for (const std::size_t place : rolling)
  {
    EXPECT_NEAR(moved.state().position.y[place], low(1, 1) * sheet.reference(place).y(), 1e-12 * sheet.length());
    slid = latcon::support::largest_of(
      {slid, std::abs(moved.state().position.x[place] - start(0, 0) * sheet.reference(place).x())});
  }
  EXPECT_GT(slid, 1e-2 * sheet.spacing());
  expect_closed_ledger(moved);
}

TEST_P(Constraints, LetSitesGoWithTheirMotion)
{
  Simulation moved = simulation({true, true, true, false});
  const std::vector<std::size_t> grip = sites_at(sheet, material, {false, false, false, true});
  moved.constrain({grip, true, true, history, first});
  Snapshot held;
  moved.save(held);
  const auto run = [&]
  {
    while (moved.state().time < third)
      moved.step();
    return moved.state().position;
  };
  const VectorField end = run();
  moved.restore(held);
  EXPECT_EQ(run().y, end.y);
  double off = 0.;
  for (const std::size_t place : grip)
    off = latcon::support::largest_of(
      {off, std::abs(moved.state().position.y[place] - start(1, 1) * sheet.reference(place).y())});
  EXPECT_GT(off, sheet.spacing());
  EXPECT_EQ(moved.state().held[grip[grip.size() / 2]], 0);
  expect_closed_ledger(moved);
}

INSTANTIATE_TEST_SUITE_P(Both, Constraints, testing::Bool(),
                         [](const auto &of) { return of.param ? "RungeKuttaChebyshev" : "VelocityVerlet"; });

TEST(Constraint, IsGivenOnce)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, start, Edges::free), 1e-9);
  const std::size_t corner = sheet.index(0, 0);
  simulation.constrain({{corner}, true, false});
  EXPECT_NO_THROW(simulation.constrain({{corner}, false, true}));
  EXPECT_THROW(simulation.constrain({{corner}, true, true}), std::logic_error);
  EXPECT_THROW(simulation.constrain({{0}, true, true}), std::invalid_argument);
  EXPECT_THROW(piecewise_linear({0., 1., 1.}, {start, low, start}), std::invalid_argument);
  EXPECT_THROW(piecewise_linear({0., 1.}, {start}), std::invalid_argument);
}

} // namespace constraint_test
