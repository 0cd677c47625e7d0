#include "lattice/snapshot.h"

#include <limits>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/running_crack.h"

namespace snapshot_test
{

using namespace latcon;

using namespace lattice;

// Back from a state that is no longer finite, a simulation is bit by bit one that was never disturbed, then and later.
TEST(Snapshot, RestoresAllThatChanges)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  std::size_t touching = 0;
  for (const auto &[stages, material] : {std::pair(0u, sheets::rubber_with_memory()),
                                         {8u, sheets::disordered_rubber()},
                                         {0u, sheets::disordered_rubber_of_three_shells()}})
  {
    const auto disturbed = running_crack::start(sheet, material, stages, true),
               reference = running_crack::start(sheet, material, stages, true);
    const auto step_both = [&](int n)
    {
      for (int step = 0; step < n; ++step)
        for (Simulation *simulation : {disturbed.get(), reference.get()})
          simulation->step();
    };
    Snapshot snapshot;
    EXPECT_TRUE(snapshot.empty());
    step_both(200);
    disturbed->save(snapshot);
    step_both(400);
    disturbed->save(snapshot); // in the same memory
    EXPECT_EQ(snapshot.time(), reference->state().time);
    const std::size_t broken = reference->n_broken();
    for (int step = 0; step < 400; ++step)
      disturbed->step();
    const Field infinite(sheet.n_places(), std::numeric_limits<double>::infinity());
    disturbed->set_velocities(infinite, infinite);
    for (int step = 0; step < 3; ++step)
      disturbed->step();
    disturbed->restore(snapshot);
    running_crack::expect_same_bits(*disturbed, *reference);
    for (int step = 0; step < 600; ++step)
    {
      step_both(1);
      touching += reference->contact()->n_touching();
    }
    EXPECT_GT(broken, 0u) << "too quiet to show anything";
    EXPECT_GT(reference->n_broken(), broken) << "too quiet to show anything";
    running_crack::expect_same_bits(*disturbed, *reference);
  }
  EXPECT_GT(touching, 0u) << "too quiet to show anything";
}

TEST(Snapshot, IsOfOneSimulation)
{
  const TriangularLattice small = sheets::square(8), large = sheets::square(10),
                          wide(sheets::spacing, 30. * sheets::spacing, 8. * sheets::spacing,
                               Orientation::rows_along_crack);
  ASSERT_EQ(wide.rows(), small.rows());
  const Material material = sheets::rubber(), remembering = sheets::rubber_with_memory();
  const auto simulation = [](const TriangularLattice &sheet, const Material &of)
  {
    return std::make_unique<Simulation>(sheet, of,
                                        homogeneous_state(sheet, of, Eigen::Matrix2d::Identity(), Edges::held), 1e-9);
  };
  EXPECT_THROW(simulation(small, material)->restore(Snapshot()), std::invalid_argument);
  Snapshot of_small;
  simulation(small, material)->save(of_small);
  EXPECT_NO_THROW(simulation(small, material)->restore(of_small));
  EXPECT_THROW(simulation(large, material)->restore(of_small), std::invalid_argument);
  EXPECT_THROW(simulation(wide, material)->restore(of_small), std::invalid_argument);
  EXPECT_THROW(simulation(small, remembering)->restore(of_small), std::invalid_argument);
}

} // namespace snapshot_test
