// A crack that runs has the same bits on any number of threads, with all instruction sets, and from a snapshot on.
#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <omp.h>

#include "tests/lattice/nonlocal_sheets.h"
#include "tests/lattice/running_crack.h"

namespace bits_test
{

using namespace latcon::lattice;

struct Crack
{
  const char *name;
  Material material;
  bool is_verlet;
  bool has_contact = true;
  double m = 0., scatter = 0.; // of a stencil, see nonlocal_sheets::sheet(); m = 0: the triangular lattice

  // A sheet with some number of sites in a row and of rows.
  TriangularLattice sheet(double columns, double rows) const
  {
    if (m > 0.)
      return nonlocal_sheets::sheet(Grid::Kind::square, m, columns / m, rows / m, 30., Orientation::rows_along_crack,
                                    scatter);
    return {sheets::spacing, columns * sheets::spacing, rows * sheets::spacing, Orientation::rows_along_crack};
  }

  std::unique_ptr<Simulation> start(const TriangularLattice &of) const
  {
    const TimeStepping stages =
      chebyshev_time_stepping(chebyshev_step(of, material, 0.45), time_step_limits(of, material, 0.3), 0);
    running_crack::Choice choice;
    choice.material = material;
    choice.stepping = is_verlet ? running_crack::stepping(of, material, 0) : stages;
    choice.contact = has_contact ? 3. : 0.;
    return running_crack::start(of, choice);
  }
};

std::ostream &operator<<(std::ostream &out, const Crack &crack)
{
  return out << crack.name;
}

using SameBits = testing::TestWithParam<Crack>;
INSTANTIATE_TEST_SUITE_P(Cracks, SameBits,
                         testing::Values(Crack{"contact", sheets::rubber(), false},
                                         Crack{"memory", sheets::rubber_with_memory(), true, false},
                                         Crack{"plastic", sheets::plastic_rubber(), false},
                                         Crack{"disorder", sheets::disordered_rubber(), false},
                                         Crack{"three shells", sheets::disordered_rubber_of_three_shells(), true},
                                         Crack{"stencil", sheets::disordered_rubber(), false, true, 2.},
                                         Crack{"scattered", sheets::disordered_rubber(), false, true, 2., 0.5}));

TEST_P(SameBits, OnAllThreadsAndInstructionSets)
{
  const TriangularLattice sheet = GetParam().sheet(90., 60.);
  ASSERT_GE(sheet.n_places(), min_places_for_threads);
  const int threads_before = omp_get_max_threads();
  const auto run = [&](int threads, const std::string &set)
  {
    omp_set_num_threads(threads);
    kernels::use_instruction_set(set);
    auto crack = GetParam().start(sheet);
    for (int step = 0; step < (GetParam().m > 0. ? 3 : 30); ++step)
      crack->step();
    return crack;
  };
  const std::vector<std::string> sets = kernels::instruction_sets();
  const auto one = run(1, sets.front());
  EXPECT_TRUE(GetParam().is_verlet || one->n_broken() > 0) << "too quiet to show anything";
  // Each set on another number of threads; the first on all, where there are fewer sets than numbers.
  const int threads[] = {2, 3, 40};
  for (std::size_t i = 0; i < std::max(sets.size(), std::size(threads)); ++i)
    running_crack::expect_same_bits(*run(threads[i % 3], sets[i < sets.size() ? i : 0]), *one);
  kernels::use_instruction_set(sets.front());
  omp_set_num_threads(threads_before);
}

// A new simulation, and one that has come to a state that is no longer finite, are bit by bit one that was never
// disturbed, then and later.
TEST_P(SameBits, FromASnapshotOn)
{
  const TriangularLattice sheet = GetParam().sheet(40., 16.);
  const auto disturbed = GetParam().start(sheet), fresh = GetParam().start(sheet), reference = GetParam().start(sheet);
  const int steps = GetParam().is_verlet ? 600 : GetParam().m > 0. ? 15 : 60;
  const auto step_all = [&](int n, std::initializer_list<Simulation *> simulations)
  {
    for (int step = 0; step < n; ++step)
      for (Simulation *simulation : simulations)
        simulation->step();
  };
  Snapshot snapshot;
  EXPECT_TRUE(snapshot.empty());
  step_all(steps / 3, {disturbed.get(), reference.get()});
  disturbed->save(snapshot);
  step_all(steps - steps / 3, {disturbed.get(), reference.get()});
  disturbed->save(snapshot); // in the same memory
  const std::size_t broken = reference->n_broken();
  step_all(steps, {disturbed.get()});
  VectorField infinite(sheet.n_places());
  for (const std::size_t place : sheet.sites())
    infinite.set(place, Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()));
  disturbed->set_velocities(infinite);
  step_all(3, {disturbed.get()});
  for (Simulation *simulation : {disturbed.get(), fresh.get()})
  {
    simulation->restore(snapshot);
    running_crack::expect_same_bits(*simulation, *reference);
  }
  std::size_t touching = 0;
  for (int step = 0; step < steps; ++step)
  {
    step_all(1, {disturbed.get(), fresh.get(), reference.get()});
    touching += GetParam().has_contact ? reference->contact()->last().size() : 0;
  }
  EXPECT_GT(broken, 0u) << "too quiet to show anything";
  EXPECT_GT(reference->n_broken(), broken) << "too quiet to show anything";
  EXPECT_EQ(touching > 0, GetParam().has_contact);
  running_crack::expect_same_bits(*disturbed, *reference);
  running_crack::expect_same_bits(*fresh, *reference);
  // For comparison between processors: tests/arm64/run.
  std::string bytes;
  for (VectorField State::*field : {&State::position, &State::velocity})
    for (const std::size_t axis : axes)
      for (const std::size_t place : sheet.sites())
        bytes.append(reinterpret_cast<const char *>(&(reference->state().*field)[axis][place]), sizeof(double));
  RecordProperty("bits", std::to_string(std::hash<std::string>{}(bytes)));
}

TEST(Snapshot, IsOfOneSimulation)
{
  const TriangularLattice small = sheets::square(8), large = sheets::square(10),
                          wide(sheets::spacing, 30. * sheets::spacing, 8. * sheets::spacing,
                               Orientation::rows_along_crack);
  ASSERT_EQ(wide.rows(), small.rows());
  const auto simulation = [](const TriangularLattice &sheet, const Material &of)
  {
    return std::make_unique<Simulation>(sheet, of,
                                        homogeneous_state(sheet, of, Eigen::Matrix2d::Identity(), Edges::held), 1e-9);
  };
  Snapshot of_small;
  EXPECT_THROW(simulation(small, sheets::rubber())->restore(of_small), std::invalid_argument);
  simulation(small, sheets::rubber())->save(of_small);
  for (const TriangularLattice *sheet : {&large, &wide})
    EXPECT_THROW(simulation(*sheet, sheets::rubber())->restore(of_small), std::invalid_argument);
  EXPECT_THROW(simulation(small, sheets::rubber_with_memory())->restore(of_small), std::invalid_argument);
}

} // namespace bits_test
