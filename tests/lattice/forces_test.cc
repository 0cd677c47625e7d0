// Forces of one bond worked out by hand; others: forces_reference_test.cc.
#include <cmath>

#include <gtest/gtest.h>

#include "lattice/forces.h"
#include "tests/lattice/sheets.h"

namespace forces_test
{

using namespace latcon;

using namespace lattice;

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
