#include "lattice/forces.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lattice/energy.h"
#include "tests/lattice/sheets.h"

namespace forces_test
{

using namespace latcon;

using namespace lattice;

// A noisy stretched sheet, free or held, with velocities as noisy as its positions.
struct NoisySheet
{
  explicit NoisySheet(Material m, Edges edges, Orientation orientation = Orientation::rows_along_crack)
    : sheet(sheets::square(14, orientation)), material(std::move(m)), forces(sheet, material),
      state(homogeneous_state(sheet, material, sheets::stretched(2.3, 2.8), edges))
  {
    State other = state;
    add_noise(state, sheet, 0.1 * sheets::spacing, 1);
    add_noise(other, sheet, 1., 2);
    for (std::size_t i = 0; i < state.x.size(); ++i)
    {
      state.vx[i] = other.x[i] - 2.3 * sheet.reference(i).x();
      state.vy[i] = other.y[i] - 2.8 * sheet.reference(i).y();
    }
  }
  TriangularLattice sheet;
  Material material;
  Forces forces;
  State state;
};

TEST(Forces, AreMinusTheEnergyGradient)
{
  Material disordered = sheets::rubber();
  disordered.disorder = sheets::disordered_rubber().disorder;
  for (const auto &[orientation, material] : {std::pair(Orientation::rows_along_crack, sheets::rubber()),
                                              {Orientation::rows_across_crack, sheets::rubber()},
                                              {Orientation::rows_along_crack, sheets::rubber_of_three_shells()},
                                              {Orientation::rows_across_crack, sheets::rubber_of_three_shells()},
                                              {Orientation::rows_along_crack, disordered}})
  {
    NoisySheet noisy(material, Edges::held, orientation);
    const Field rest(noisy.sheet.n_places(), 0.);
    noisy.forces.evaluate(noisy.state, rest, rest);
    // Along a random direction the remainder of a central difference falls with h^2.
    State direction = noisy.state;
    add_noise(direction, noisy.sheet, sheets::spacing, 3);
    double slope = 0.;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      direction.x[i] -= noisy.state.x[i];
      direction.y[i] -= noisy.state.y[i];
      slope -= noisy.forces.fx()[i] * direction.x[i] + noisy.forces.fy()[i] * direction.y[i];
    }
    const auto energy_at = [&](double h)
    {
      State moved = noisy.state;
      for (std::size_t i = 0; i < rest.size(); ++i)
      {
        moved.x[i] += h * direction.x[i];
        moved.y[i] += h * direction.y[i];
      }
      return elastic_energy(moved, noisy.sheet, noisy.material);
    };
    const auto error = [&](double h) { return std::abs((energy_at(h) - energy_at(-h)) / (2. * h) - slope); };
    EXPECT_NEAR(std::log2(error(4e-2) / error(1e-2)) / 2., 2., 0.1);
    EXPECT_LT(error(1e-2), 1e-3 * std::abs(slope));
  }
}

// One bond along x drawn apart at a known speed: A0 (psi' + eta v / l), and the power is the viscous part times v.
// theory.md, eqs. (L.3) and (L.4).
TEST(Forces, AreTheBondLawAndDashpotOfOneBond)
{
  const TriangularLattice sheet = sheets::square(14);
  const Material material = sheets::rubber();
  State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free);
  const std::size_t left = sheet.index(6, 6), right = left + 1;
  state.bonds.clear(sheet.n_places());
  state.bonds.add(left, 0);
  state.x[right] += sheets::spacing; // stretch 2
  state.vx[right] = 5.;
  Forces forces(sheet, material);
  forces.evaluate(state, state.vx, state.vy);
  // A0 / h = 2/3 (sqrt3 / 2) d; psi'(2) = 7/4 a + 7/8 b.
  const double section = 2. / 3. * std::sqrt(3.) / 2. * sheets::spacing;
  const double viscous = section * 65.625 * 5. / sheets::spacing;
  const double expected = section * (1.75 * 1e5 + 0.875 * 1.5e5) + viscous;
  EXPECT_NEAR(forces.fx()[left], expected, 1e-12 * expected);
  EXPECT_NEAR(forces.fx()[right], -expected, 1e-12 * expected);
  EXPECT_EQ(forces.fy()[left], 0.);
  EXPECT_NEAR(forces.viscous_power(), viscous * 5., 1e-12 * viscous * 5.);
}

} // namespace forces_test
