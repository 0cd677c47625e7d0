#include "lattice/bonds/bond_memory.h"

#include <any>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>
#include <omp.h>

#include "support/largest_error.h"
#include "tests/lattice/running_crack.h"

namespace bond_memory_test
{

using namespace latcon;

using namespace lattice;
using Branch = MaxwellMemory::Branch;

const TimeStepping verlet{2e-7}, chebyshev{1e-6, 5};

// A sheet at rest in the reference configuration that is stretched at once and held: its sites stay where they are, in
// equilibrium by symmetry, and each branch of a bond decays with its own time.
struct HeldSheet
{
  HeldSheet(const TimeStepping &stepping, const Material &material_)
    : sheet(sheets::square(12)), material(material_), F(sheets::stretched(1.4, 1.3))
  {
    State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
    relax_memory(state, sheet, material);
    const State loaded = homogeneous_state(sheet, material, F, Edges::held);
    state.x = loaded.x;
    state.y = loaded.y;
    simulation = std::make_unique<Simulation>(sheet, material, std::move(state), stepping);
  }
  // Sum over bonds and branches of A0 l (E e^2 / 2) e^(-2 t / tau), e being the stretch that came at once.
  double stored_at(double time) const
  {
    double sum = 0.;
    for_each_bond(simulation->state(), sheet,
                  [&](const Bond &bond)
                  {
                    const Shell &shell = *material.shell(bond.kind);
                    const double l = sheet.rest_length(bond.kind),
                                 e = (F * sheet.bond_vector(bond.kind)).norm() / l - 1.;
                    const std::vector<Branch> branches =
                      TriangularLattice::is_nearest(bond.kind)
                        ? std::get<MaxwellMemory>(shell.memory).branches()
                        : std::vector<Branch>{{1.5e5, 5e-5}}; // sheets::rubber_with_memory
                    for (const auto &[modulus, tau] : branches)
                      sum += cross_section(shell, sheet) * l * 0.5 * modulus * e * e * std::exp(-2. * time / tau);
                  });
    return sum;
  }
  TriangularLattice sheet;
  Material material;
  Eigen::Matrix2d F;
  std::unique_ptr<Simulation> simulation;
};

// theory.md, eqs. (L.27) and (L.29).
TEST(BondMemory, RelaxesInAHeldSheet)
{
  for (const TimeStepping &stepping : {verlet, chebyshev})
  {
    HeldSheet held(stepping, sheets::rubber_with_memory());
    Simulation &simulation = *held.simulation;
    const double stored = held.stored_at(0.), elastic = elastic_energy(simulation.state(), held.sheet, held.material);
    EXPECT_NEAR(simulation.energies().elastic, elastic + stored, 1e-12 * elastic);
    const auto steps = static_cast<int>(std::lround(1e-4 / stepping.step));
    for (int step = 1; step <= steps; ++step)
    {
      simulation.step();
      // One rounding a step; sites move by the round-off of their forces.
      const double now = memory_energy(simulation.state(), held.sheet, held.material);
      ASSERT_NEAR(now, held.stored_at(step * stepping.step), 1e-11 * stored) << step;
    }
    ASSERT_LT(held.stored_at(1e-4), 0.2 * stored);
    // The trapezoidal rule is off by (h^2 / 12) (4 / tau^2) of each e^(-2t/tau), at most by that of the shortest time.
    const EnergyBalance e = simulation.energies();
    const double trapezoidal = std::pow(stepping.step / 2e-5, 2) / 3.;
    EXPECT_NEAR(e.viscous, stored - held.stored_at(1e-4), trapezoidal * stored);
    EXPECT_LT(std::abs(e.imbalance()), trapezoidal * stored);
    EXPECT_EQ(e.initial, e.elastic + e.kinetic + e.viscous - e.imbalance());
    EXPECT_LT(e.kinetic, 1e-20 * stored);
  }
}

// Oscillations of a noisy sheet, in which stretches do not change linearly: energies at a time that all steps meet.
double observed_order(const std::function<TimeStepping(double)> &with_step, double h,
                      const std::function<double(const Simulation &)> &quantity)
{
  const TriangularLattice sheet = sheets::square(10);
  const Material material = sheets::rubber_with_memory(5.);
  std::vector<double> results;
  for (const double step : {h, h / 2., h / 4.})
  {
    State state = homogeneous_state(sheet, material, sheets::stretched(1.3, 1.4), Edges::held);
    add_noise(state, sheet, 0.05 * sheets::spacing, 5);
    Simulation simulation(sheet, material, std::move(state), with_step(step));
    for (int i = 0; i < static_cast<int>(std::lround(4e-5 / step)); ++i)
      simulation.step();
    results.push_back(quantity(simulation));
  }
  return std::log2(std::abs(results[0] - results[1]) / std::abs(results[1] - results[2]));
}

TEST(BondMemory, LeavesIntegratorsAtSecondOrder)
{
  const auto of_verlet = [](double h) { return TimeStepping(h); };
  const auto of_chebyshev = [](double h) { return TimeStepping(h, 6); };
  const auto stored = [](const Simulation &s) { return memory_energy(s.state(), s.lattice(), s.material()); };
  const auto kinetic = [](const Simulation &s) { return kinetic_energy(s.state(), s.lattice()); };
  for (const auto &quantity : {std::function<double(const Simulation &)>(stored), {kinetic}})
  {
    EXPECT_NEAR(observed_order(of_verlet, 1e-7, quantity), 2., 0.1);
    EXPECT_NEAR(observed_order(of_chebyshev, 2e-7, quantity), 2., 0.15);
  }
}

// Materials, each for velocity Verlet and for a number of stages, which take steps that are three times as long.
std::vector<std::pair<unsigned int, Material>> remembering_rubbers()
{
  std::vector<std::pair<unsigned int, Material>> all;
  for (const unsigned int stages : {0u, 8u})
    for (const Material &material :
         {sheets::rubber_with_memory(), sheets::disordered_rubber(), sheets::plastic_rubber()})
      all.emplace_back(stages, material);
  return all;
}

// theory.md, eq. (L.29).
TEST(BondMemory, ClosesTheEnergyBalanceThroughFracture)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  for (const auto &[stages, material] : remembering_rubbers())
  {
    const auto simulation = running_crack::start(sheet, material, stages);
    for (int step = 0; step < (stages > 0 ? 700 : 2000); ++step)
      simulation->step();
    const EnergyBalance e = simulation->energies();
    EXPECT_GT(simulation->n_broken(), 15u);
    const double stored = memory_energy(simulation->state(), sheet, simulation->material());
    EXPECT_GT(stored, 1e-4 * e.initial) << "too quiet to show anything";
    // Branches or the slider of nearest neighbours, and the memory of the others.
    const std::vector<MechanismEnergy> mechanisms = simulation->mechanism_energies();
    ASSERT_EQ(mechanisms.size(), n_mechanisms(material.nearest.memory) + 1);
    double stored_sum = 0., dissipated_sum = 0.;
    for (const MechanismEnergy &mechanism : mechanisms)
    {
      EXPECT_GT(mechanism.stored, 0.);
      EXPECT_GT(mechanism.dissipated, 0.);
      stored_sum += mechanism.stored;
      dissipated_sum += mechanism.dissipated;
    }
    EXPECT_NEAR(stored_sum, stored, 1e-12 * stored);
    EXPECT_LT(dissipated_sum, e.viscous);
    // The error of the time stepping, far below what memories hold.
    EXPECT_LT(std::abs(e.imbalance()), 1e-2 * stored);
  }
}

// An archive in memory.
using Stored = std::map<std::string, std::any>;
template <bool is_loading>
class Archive
{
public:
  static constexpr bool loads = is_loading;
  explicit Archive(Stored &stored, std::string prefix = "") : stored_(stored), prefix_(std::move(prefix)) {}

  void operator()(const std::string &name, Fracture &part) const
  {
    Archive inner(stored_, prefix_ + name + "/");
    part.archive(inner);
  }
  template <class Value>
  void operator()(const std::string &name, Value &value) const
  {
    if constexpr (loads)
      value = std::any_cast<Value>(stored_.at(prefix_ + name));
    else
      stored_[prefix_ + name] = value;
  }

private:
  Stored &stored_;
  std::string prefix_;
};

TEST(BondMemory, ResumesBitwise)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  std::vector<std::pair<unsigned int, Material>> subjects = remembering_rubbers();
  subjects.emplace_back(8u, sheets::disordered_rubber_of_three_shells());
  for (const auto &[stages, material] : subjects)
  {
    const int steps = stages > 0 ? 400 : 1200;
    const auto whole = running_crack::start(sheet, material, stages);
    Stored stored;
    std::size_t broken_when_saved = 0;
    for (int step = 0; step < steps; ++step)
    {
      if (step == steps / 2)
      {
        Archive<false> saving(stored);
        whole->archive(saving);
        broken_when_saved = whole->n_broken();
      }
      whole->step();
    }
    const auto resumed = running_crack::start(sheet, material, stages);
    Archive<true> loading(stored);
    resumed->archive(loading);
    for (int step = steps / 2; step < steps; ++step)
      resumed->step();
    EXPECT_GT(broken_when_saved, 0u) << "too quiet to show anything";
    EXPECT_GT(whole->n_broken(), broken_when_saved) << "too quiet to show anything";
    running_crack::expect_same_bits(*resumed, *whole);
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

TEST(BondMemory, HasTheSameBitsForAllThreadsAndInstructionSets)
{
  // More than min_places_for_threads places.
  const TriangularLattice sheet(sheets::spacing, 90. * sheets::spacing, 60. * sheets::spacing,
                                Orientation::rows_along_crack);
  ASSERT_GE(sheet.n_places(), min_places_for_threads);
  const int threads_before = omp_get_max_threads();
  const auto run = [&](int threads, const std::string &set, const Material &material)
  {
    omp_set_num_threads(threads);
    kernels::use_instruction_set(set);
    auto simulation = running_crack::start(sheet, material);
    for (int step = 0; step < 30; ++step)
      simulation->step();
    return simulation;
  };
  const std::vector<std::string> sets = kernels::instruction_sets();
  for (const Material &material : {sheets::rubber_with_memory(), sheets::disordered_rubber(), sheets::plastic_rubber()})
  {
    const auto one = run(1, sets.front(), material);
    for (const int threads : {2, 3, 40})
      running_crack::expect_same_bits(*run(threads, sets.front(), material), *one);
    for (const std::string &set : sets)
      running_crack::expect_same_bits(*run(2, set, material), *one);
  }
  kernels::use_instruction_set(sets.front());
  omp_set_num_threads(threads_before);
}

// Without viscosity the mechanisms dissipate everything, broken bonds included; stresses of sites contain overstresses.
TEST(BondMemory, RecordsEnergiesByMechanism)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  for (const Material &material : {sheets::rubber_with_memory(0.), sheets::plastic_rubber(0.)})
  {
    const auto simulation = running_crack::start(sheet, material);
    for (int step = 0; step < 600; ++step)
      simulation->step();
    ASSERT_GT(simulation->n_broken(), 0u) << "too quiet to show anything";
    double dissipated = 0.;
    for (const MechanismEnergy &mechanism : simulation->mechanism_energies())
      dissipated += mechanism.dissipated;
    EXPECT_GT(dissipated, 0.);
    // 600 steps, each rounding sums over a few hundred bonds.
    EXPECT_NEAR(dissipated, simulation->energies().viscous, 1e-11 * dissipated);
  }
}

// Forces that bonds between an update and the next have by the kernel of a row and by that of one bond.
TEST(BondMemory, ActsOnOneSiteAsInTheLoop)
{
  for (const Periodic periodic : {Periodic{}, Periodic{true, true}})
  {
    const TriangularLattice sheet(sheets::spacing, 13. * sheets::spacing, 9. * sheets::spacing,
                                  Orientation::rows_along_crack, periodic);
    Material material = sheets::rubber_with_memory();
    material.disorder.stiffness = {Distribution::Kind::uniform, 0.3};
    State state = homogeneous_state(sheet, material, sheets::stretched(1.6, 1.9), Edges::free);
    relax_memory(state, sheet, material);
    Forces forces(sheet, material), without(sheet, sheets::rubber());
    for (const unsigned int seed : {1u, 2u})
    {
      forces.update_memory(state);
      add_noise(state, sheet, 0.1 * sheets::spacing, seed);
      state.bonds.remove(sheet.index(4, 4 + seed), 1);
      forces.set_elapsed(3e-5);
    }
    forces.evaluate(state, state.vx, state.vy);
    without.evaluate(state, state.vx, state.vy);
    double difference = 0.;
    for (const std::size_t place : sheets::sites(sheet))
    {
      const Eigen::Vector2d force = forces.on_site(state, state.vx, state.vy, place);
      ASSERT_EQ(force.x(), forces.fx()[place]);
      ASSERT_EQ(force.y(), forces.fy()[place]);
      difference = support::largest_of({difference, std::abs(force.x() - without.fx()[place])});
    }
    EXPECT_GT(difference, 0.);
    // An update changes neither forces nor power.
    const Field fx = forces.fx();
    const double power = forces.viscous_power();
    EXPECT_GT(power, 0.);
    forces.update_memory(state);
    forces.evaluate(state, state.vx, state.vy);
    EXPECT_TRUE(running_crack::same_bits(forces.fx(), fx));
    EXPECT_EQ(forces.viscous_power(), power);
  }
}

// Memories from outside give latcon's own to the round-off of std::exp or of a quotient, step by step.
TEST(CustomMemory, ActsAsTheSameMemoryInTheHotLoop)
{
  const Branch branch{1.5e5, 5e-5};
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

// A material without memory stores nothing, and statics is that of the law alone.
TEST(BondMemory, IsLeftOutOfEquilibrium)
{
  const TriangularLattice sheet = sheets::square(6);
  State state = homogeneous_state(sheet, sheets::rubber(), sheets::stretched(1.2, 1.2), Edges::held);
  const Simulation simulation(sheet, sheets::rubber(), state, 1e-7);
  EXPECT_TRUE(simulation.state().history.empty());
  EXPECT_FALSE(sheets::rubber().has_memory());
  EXPECT_TRUE(sheets::rubber_with_memory().has_memory());
  EXPECT_FALSE(without_dashpots(sheets::rubber_with_memory()).has_memory());
}

} // namespace bond_memory_test
