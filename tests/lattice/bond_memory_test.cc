#include "lattice/bonds/memories.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/running_crack.h"

namespace bond_memory_test
{

using namespace latcon;

using namespace lattice;

// With velocity Verlet and in stages; without viscosity the mechanisms dissipate everything, in broken bonds as well.
// theory.md, eq. (L.29).
TEST(BondMemory, ClosesTheEnergyBalanceThroughFracture)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  for (const auto &[stages, material] : {std::pair(0u, sheets::rubber_with_memory()),
                                         {8u, sheets::rubber_with_memory()},
                                         {0u, sheets::plastic_rubber()},
                                         {8u, sheets::plastic_rubber()},
                                         {0u, sheets::disordered_rubber()},
                                         {0u, sheets::rubber_with_memory(0.)},
                                         {0u, sheets::plastic_rubber(0.)}})
  {
    running_crack::Choice choice;
    choice.material = material;
    choice.stepping = running_crack::stepping(sheet, material, stages);
    const auto simulation = running_crack::start(sheet, choice);
    for (int step = 0; step < (stages > 0 ? 700 : 2000); ++step)
      simulation->step();
    const EnergyBalance e = simulation->energies();
    EXPECT_GT(simulation->n_broken(), 15u);
    const double stored = memory_energy(simulation->state(), sheet, simulation->material());
    EXPECT_GT(stored, 1e-4 * e.initial) << "too quiet to show anything";
    // Branches or the slider of nearest neighbours, and the memory of the others.
    const std::vector<MechanismEnergy> mechanisms = simulation->mechanism_energies();
    ASSERT_EQ(mechanisms.size(), properties(material.nearest.memory).n_mechanisms + 1);
    double stored_sum = 0., dissipated_sum = 0.;
    for (const MechanismEnergy &mechanism : mechanisms)
    {
      EXPECT_GT(mechanism.stored, 0.);
      EXPECT_GT(mechanism.dissipated, 0.);
      stored_sum += mechanism.stored;
      dissipated_sum += mechanism.dissipated;
    }
    EXPECT_NEAR(stored_sum, stored, 1e-12 * stored);
    if (material.nearest.viscosity > 0.)
      EXPECT_LT(dissipated_sum, e.viscous);
    else // 2000 steps, each rounding sums over a few hundred bonds
      EXPECT_NEAR(dissipated_sum, e.viscous, 1e-11 * e.viscous);
    // The error of the time stepping, far below what memories hold.
    EXPECT_LT(std::abs(e.imbalance()), 1e-2 * stored);
  }
}

TEST(BondMemory, RejectsHistoryOfOtherMemories)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  const Material material = sheets::rubber_with_memory();
  State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  relax_memory(state, RowPartition(sheet), material);
  const auto start = [&](const State &from) { return Simulation(RowPartition(sheet), material, from, {1e-7, 0}); };
  EXPECT_NO_THROW(start(state));
  State fewer_variables = state, fewer_places = state, one_shell = state;
  fewer_variables.history.kinds[0].variables.pop_back();
  fewer_places.history.kinds[0].variables[0].pop_back();
  for (BondHistory::Kind &kind : one_shell.history.kinds)
    if (&kind != &one_shell.history.kinds[0])
      kind = {};
  for (const State *wrong : {&fewer_variables, &fewer_places, &one_shell})
    EXPECT_THROW(start(*wrong), std::invalid_argument);
}

// Memories from outside give latcon's own to the round-off of std::exp or of a quotient, step by step.
TEST(CustomMemory, ActsAsTheSameMemoryInTheHotLoop)
{
  const MaxwellMemory::Branch branch{1.5e5, 5e-5};
  const std::vector<std::pair<BondMemory, BondMemory>> same{
    {MaxwellMemory({branch}), sheets::memory_from_outside(branch)},
    {PlasticMemory(1.5e5, 1e3, 2e4), CustomMemory(std::make_shared<sheets::SliderFromOutside>(1.5e5, 1e3, 2e4))}};
  const TriangularLattice sheet = sheets::square(10);
  const auto run = [&](const BondMemory &memory)
  {
    Material material = sheets::nearest_only(5.);
    material.nearest.memory = memory;
    State state = homogeneous_state(sheet, material, sheets::stretched(1.3, 1.4), Edges::held);
    add_noise(state, sheet, 0.05 * sheets::spacing, 5);
    Simulation simulation(sheet, material, std::move(state), 2e-7);
    for (int step = 0; step < 100; ++step)
      simulation.step();
    EXPECT_GT(simulation.mechanism_energies()[0].dissipated, 0.);
    return simulation.energies();
  };
  for (const auto &[inside, outside] : same)
  {
    const EnergyBalance in = run(inside), out = run(outside);
    // 100 steps of some 1e-15 each.
    EXPECT_NEAR(in.viscous, out.viscous, 1e-12 * in.viscous);
    EXPECT_NEAR(in.elastic, out.elastic, 1e-12 * in.elastic);
    EXPECT_NEAR(in.kinetic, out.kinetic, 1e-11 * in.kinetic);
  }
}

} // namespace bond_memory_test
