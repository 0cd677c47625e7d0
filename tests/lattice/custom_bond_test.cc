#include "lattice/bonds/custom_bond.h"

#include "lattice/bonds/bond_law.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/relaxation.h"
#include "lattice/time_step.h"
#include "tests/lattice/running_crack.h"

namespace custom_bond_test
{

using namespace latcon;

using namespace lattice;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A linear law with mistakes to choose.
struct Mistaken
{
  double at_rest = 0.;                                      // energy [Pa]
  double pull = 0.;                                         // force at rest [Pa]
  double modulus = 2e5;                                     // [Pa]
  double longest = std::numeric_limits<double>::infinity(); // beyond this stretch there is no value

  double within(double stretch, double value) const { return stretch <= longest ? value : nan; }
  double energy(double stretch) const
  {
    return within(stretch, at_rest + 0.5 * modulus * (stretch - 1.) * (stretch - 1.));
  }
  double force(double stretch) const { return within(stretch, pull + modulus * (stretch - 1.)); }
  double stiffness(double stretch) const { return within(stretch, modulus); }
  double largest_stiffness(double) const { return 4. * modulus; }
};

TEST(CustomBond, HasToBeFreeAndStiffAtRest)
{
  EXPECT_THROW(CustomBond(nullptr), std::invalid_argument);
  EXPECT_NO_THROW(sheets::from_outside(Mistaken{}));
  EXPECT_NO_THROW(sheets::from_outside(Mistaken{1e-8, -1e-8})); // round-off of 2e5 Pa
  for (const Mistaken &law : {Mistaken{1.}, Mistaken{0., -1.}, Mistaken{nan}, Mistaken{0., nan}, Mistaken{0., 0., 0.},
                              Mistaken{0., 0., -1.}, Mistaken{0., 0., nan}})
    EXPECT_THROW(sheets::from_outside(law), std::invalid_argument);
}

// Energy, force and stiffness are those of a law that bond_law_test.cc tries by Taylor's theorem.
TEST(CustomBond, HasTheValuesOfItsLaw)
{
  const MooneyRivlinBond inside{1e5, 1.5e5};
  const BondLaw outside = sheets::from_outside(inside);
  for (const double stretch : {0.4, 1., 1.7, 3.05})
  {
    EXPECT_EQ(energy(outside, stretch), inside.energy(stretch));
    EXPECT_EQ(force(outside, stretch), force(inside, stretch));
    EXPECT_EQ(stiffness(outside, stretch), inside.stiffness(stretch));
    EXPECT_EQ(largest_stiffness(outside, stretch), inside.largest_stiffness(stretch));
  }
}

// Bond after bond, and every position to the last bit: the linear law does the same roundings wherever it is.
TEST(CustomBond, CracksAsTheSameLawInTheHotLoop)
{
  const TriangularLattice sheet = running_crack::small_sheet();
  Material inside = sheets::rubber(), outside = inside;
  inside.nearest.law = LinearBond{2e5};
  outside.nearest.law = sheets::from_outside(LinearBond{2e5});
  const auto expected = running_crack::start(sheet, inside), simulation = running_crack::start(sheet, outside);
  EXPECT_EQ(simulation->time_step(), expected->time_step());
  for (int step = 0; step < 1800; ++step)
  {
    simulation->step();
    expected->step();
  }
  EXPECT_GT(expected->n_broken(), 20u) << "too quiet to show anything";
  running_crack::expect_same_bits(*simulation, *expected);
}

TEST(CustomBond, BoundsTheTimeStepByItsLargestStiffness)
{
  const TriangularLattice sheet = sheets::square(6);
  Material material = sheets::nearest_only(0.);
  material.nearest.law = LinearBond{2e5};
  const double linear = time_step_limits(sheet, material, 0.5).elastic;
  material.nearest.law = sheets::from_outside(Mistaken{}); // says four times as much
  EXPECT_DOUBLE_EQ(time_step_limits(sheet, material, 0.5).elastic, 0.5 * linear);
  material.nearest.viscosity = 1e-3;
  EXPECT_DOUBLE_EQ(chebyshev_step(sheet, material, 0.5), 1e-3 / 8e5);
}

// A law without a value gives NaN at the ends of its bond alone; a relaxation stops.
TEST(CustomBond, WithoutAValueIsSeen)
{
  const TriangularLattice sheet = sheets::square(8);
  Material material = sheets::nearest_only(0.);
  material.nearest.law = sheets::from_outside(Mistaken{0., 0., 2e5, 1.5});
  State state = homogeneous_state(sheet, material, sheets::stretched(1.2, 1.2), Edges::held);
  const std::size_t left = sheet.index(3, 3), right = left + 1;
  state.x[left] -= 0.2 * sheets::spacing; // now the bonds to its right have stretches of 1.4 and less
  Forces forces(sheet, material);
  forces.evaluate(state, state.vx, state.vy);
  EXPECT_TRUE(std::isfinite(forces.fx()[left]));
  state.x[left] -= 0.2 * sheets::spacing; // 1.6 along the row, 1.44 upwards
  forces.evaluate(state, state.vx, state.vy);
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    EXPECT_EQ(std::isfinite(forces.fx()[place]), place != left && place != right) << place;
    EXPECT_EQ(std::isfinite(forces.fy()[place]), place != left && place != right) << place;
  }
  EXPECT_THROW(relax(state, sheet, material, 1e-6), std::runtime_error);
}

} // namespace custom_bond_test
