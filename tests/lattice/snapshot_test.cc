#include "lattice/snapshot.h"

#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "lattice/site_fields.h"
#include "tests/lattice/sheets.h"

namespace snapshot_test
{

using namespace latcon;

using namespace lattice;

// A running crack with contact behind it.
std::unique_ptr<Simulation> crack(const TriangularLattice &sheet, const Material &material, unsigned int stages)
{
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.9);
  State state = homogeneous_state(sheet, material, F, Edges::held);
  add_noise(state, sheet, 0.05 * sheets::spacing, 1);
  const double step = 0.5 * time_step_limits(sheet, material, 0.3).combined;
  const TimeStepping stepping = stages > 0 ? TimeStepping(3. * step, stages) : TimeStepping(step);
  auto simulation = std::make_unique<Simulation>(sheet, material, std::move(state), stepping,
                                                 Fracture(sheet, material, 3.05, BehindTipToughening{2.5e-3, 3.}, F));
  simulation->enable_contact(contact_like_nearest_bond(sheet, material, 3. * sheets::spacing, 0.1, 0.1));
  simulation->cut(sheets::middle_row(sheet, 4, 8));
  return simulation;
}

TriangularLattice cracked_sheet()
{
  return {sheets::spacing, 40. * sheets::spacing, 16. * sheets::spacing, Orientation::rows_along_crack};
}

bool same_bits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

void expect_same_bits(const Simulation &one, const Simulation &other)
{
  const State &a = one.state(), &b = other.state();
  EXPECT_EQ(a.time, b.time);
  for (std::size_t place = 0; place < one.lattice().n_places(); ++place)
    for (std::size_t kind = 0; kind < a.bonds.n_kinds(); ++kind)
    {
      ASSERT_EQ(a.bonds.present(place, kind), b.bonds.present(place, kind));
      ASSERT_EQ(a.bonds.toughened(place, kind), b.bonds.toughened(place, kind));
    }
  EXPECT_EQ(a.lost_bonds, b.lost_bonds);
  EXPECT_EQ(one.tip(), other.tip());
  EXPECT_EQ(one.n_broken(), other.n_broken());
  const EnergyBalance e = one.energies(), f = other.energies();
  EXPECT_EQ(e.viscous, f.viscous);
  EXPECT_EQ(e.contact, f.contact);
  EXPECT_EQ(e.imbalance(), f.imbalance());
  // Stresses, which depend on the memory of bonds, as frames have them.
  const SiteEvaluator evaluator(one.lattice(), one.material());
  for (std::size_t row = 0; row < one.lattice().rows(); ++row)
    for (std::size_t column = 0; column < one.lattice().sites_in_row(row); ++column)
    {
      const std::size_t place = one.lattice().index(row, column);
      for (Field State::*field : {&State::x, &State::y, &State::vx, &State::vy, &State::ax, &State::ay})
        ASSERT_TRUE(same_bits((a.*field)[place], (b.*field)[place])) << "row " << row << ", column " << column;
      ASSERT_EQ(evaluator.at(a, place).first_piola_stress, evaluator.at(b, place).first_piola_stress)
        << "row " << row << ", column " << column;
    }
}

// Back from a state that is no longer finite, a simulation is bit by bit one that was never disturbed, then and later.
TEST(Snapshot, RestoresAllThatChanges)
{
  const TriangularLattice sheet = cracked_sheet();
  std::size_t touching = 0;
  for (const auto &[stages, material] : {std::pair(0u, sheets::rubber_with_memory()),
                                         {8u, sheets::disordered_rubber()},
                                         {0u, sheets::disordered_rubber_of_three_shells()}})
  {
    const auto disturbed = crack(sheet, material, stages), reference = crack(sheet, material, stages);
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
    expect_same_bits(*disturbed, *reference);
    for (int step = 0; step < 600; ++step)
    {
      step_both(1);
      touching += reference->contact()->n_touching();
    }
    EXPECT_GT(broken, 0u) << "too quiet to show anything";
    EXPECT_GT(reference->n_broken(), broken) << "too quiet to show anything";
    expect_same_bits(*disturbed, *reference);
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
