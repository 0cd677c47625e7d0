// The motion of a sheet must not depend on its size or units. Where only powers of two change, bits must not change
// either. Orientation and reflection: crack_test.cc.
#include <cmath>
#include <memory>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/lattice/running_crack.h"

namespace lattice_symmetry_test
{

using namespace latcon;

using namespace lattice;

// Units of a sheet in those of another one: whatever has none, angles, stretches, numbers of bonds, stays as it is.
//
// With lengths l, stresses e and densities r times as large, f = m a reads e l f = (r l^2) (l / t^2) a for the force
// per thickness of a bond, A0 psi' with A0 ~ l, and of a contact, k o, hence the time t = l sqrt(r / e), and for
// dashpots, A0 eta v / l, a viscosity e t. Velocities go with l / t, forces with e l, energies per thickness with e
// l^2.
struct Units
{
  double length = 1., stress = 1., density = 1.;
  double time() const { return length * std::sqrt(density / stress); }
  double viscosity() const { return stress * time(); }
  double velocity() const { return length / time(); }
  double energy() const { return stress * length * length; }
};

Material rubber_in(const Units &units)
{
  Material material = sheets::rubber();
  material.density *= units.density;
  for (Shell *shell : {&material.nearest, &*material.next_nearest})
  {
    auto &law = std::get<MooneyRivlinBond>(shell->law);
    law.a *= units.stress;
    law.b *= units.stress;
    shell->viscosity *= units.viscosity();
  }
  return material;
}

// A bond that broke: step, place of its near end, kind.
using Break = std::tuple<int, std::size_t, std::size_t>;

// A small sheet with a crack whose flanks touch, in some units.
struct Crack
{
  explicit Crack(running_crack::Choice choice, const Units &units = {}, unsigned int stages = 0)
    : sheet(units.length * sheets::spacing, 60. * units.length * sheets::spacing, 36. * units.length * sheets::spacing,
            Orientation::rows_along_crack)
  {
    choice.material = rubber_in(units);
    choice.stepping = stages == 0 ? TimeStepping(0.9 * time_step_limits(sheet, choice.material, 0.3).combined)
                                  : TimeStepping(chebyshev_step(sheet, choice.material, 1.), stages);
    choice.contact = 3.;
    choice.toughening.distance *= units.length;
    simulation = running_crack::start(sheet, choice);
  }

  std::vector<Break> run(int steps)
  {
    std::vector<Break> breaks;
    for (int step = 0; step < steps; ++step)
      for (const BrokenBond &bond : simulation->step())
        breaks.emplace_back(step, bond.near, bond.kind);
    return breaks;
  }

  TriangularLattice sheet;
  std::unique_ptr<Simulation> simulation;
};

// Positions, velocities and energies of a sheet are those of another one in other units, bit by bit.
void expect_scaled(const Crack &one, const Crack &other, const Units &units)
{
  const State &a = one.simulation->state(), &b = other.simulation->state();
  for (std::size_t place = 0; place < a.position.x.size(); ++place)
  {
    ASSERT_EQ(b.position.x[place], units.length * a.position.x[place]);
    ASSERT_EQ(b.position.y[place], units.length * a.position.y[place]);
    ASSERT_EQ(b.velocity.x[place], units.velocity() * a.velocity.x[place]);
    ASSERT_EQ(b.velocity.y[place], units.velocity() * a.velocity.y[place]);
  }
  for (const auto energy : sheets::energies)
    EXPECT_EQ(other.simulation->energies().*energy, units.energy() * (one.simulation->energies().*energy));
}

using Similarity = testing::TestWithParam<unsigned int>;
INSTANTIATE_TEST_SUITE_P(Stages, Similarity, testing::Values(0u, 4u));

// All units are powers of two, so that a run in others has the same mantissas throughout.
TEST_P(Similarity, CrackInOtherUnitsIsTheSameCrack)
{
  const int steps = GetParam() == 0 ? 2500 : 250;
  running_crack::Choice choice;
  choice.left = EndLoads::End::absorbing;
  choice.right = EndLoads::End::free;
  Crack one(choice, {}, GetParam());
  const std::vector<Break> breaks = one.run(steps);
  EXPECT_GT(breaks.size(), 50u);
  EXPECT_NE(one.simulation->energies().contact, 0.) << "flanks or debris must have touched";
  for (const Units &units : {Units{4., 1., 1.}, Units{1., 4., 16.}, Units{0.25, 0.25, 4.}})
  {
    Crack other(choice, units, GetParam());
    EXPECT_EQ(other.simulation->time_step(), units.time() * one.simulation->time_step());
    EXPECT_EQ(other.run(steps), breaks);
    expect_scaled(one, other, units);
  }
}

} // namespace lattice_symmetry_test
