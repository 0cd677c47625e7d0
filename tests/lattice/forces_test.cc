// Forces of one bond worked out by hand, and in copies of a cell; others: forces_reference_test.cc.
#include <cmath>

#include <gtest/gtest.h>

#include "lattice/energy.h"
#include "lattice/forces.h"
#include "support/largest_error.h"
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

// The smallest cell, two rows of two sites, is bonded to itself over and over. Laid out three times along and across
// without anything repeating, it must feel the same forces.
TEST(Forces, OfTheSmallestCellAreThoseOfItsCopiesInALargeSheet)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    const Material material = sheets::rubber();
    const bool along_x = orientation == Orientation::rows_along_crack;
    const double pitch = std::sqrt(3.) / 2.;
    const auto sheet_of = [&](double columns, double rows)
    {
      const double d = sheets::spacing;
      return along_x ? TriangularLattice(d, columns * d, rows * pitch * d, orientation, {true, true})
                     : TriangularLattice(d, rows * pitch * d, columns * d, orientation, {true, true});
    };
    const TriangularLattice cell = sheet_of(2., 2.), large = sheet_of(6., 6.);
    ASSERT_EQ(cell.n_sites(), 4u);
    ASSERT_EQ(large.n_sites(), 36u);
    const Eigen::Matrix2d F = sheets::stretched(1.3, 1.6);
    State small = homogeneous_state(cell, material, F, Edges::held);
    add_noise(small, cell, 0.1 * sheets::spacing, 3);
    for (const std::size_t place : sheets::sites(cell))
    {
      small.vx[place] = 0.3 * static_cast<double>(place % 5);
      small.vy[place] = -0.2 * static_cast<double>(place % 7);
    }
    update_images(small, cell);
    State copies = homogeneous_state(large, material, F, Edges::held);
    const auto original = [&](std::size_t place)
    { return cell.index(large.row_of(place) % 2, large.column_of(place) % 2); };
    for (const std::size_t place : sheets::sites(large))
    {
      const std::size_t from = original(place);
      const Eigen::Vector2d at_rest = F * cell.reference(from);
      copies.x[place] += small.x[from] - at_rest.x();
      copies.y[place] += small.y[from] - at_rest.y();
      copies.vx[place] = small.vx[from];
      copies.vy[place] = small.vy[from];
    }
    update_images(copies, large);
    Forces in_cell(cell, material), in_large(large, material);
    in_cell.evaluate(small, small.vx, small.vy);
    in_large.evaluate(copies, copies.vx, copies.vy);
    double largest = 0.;
    for (const std::size_t place : sheets::sites(cell))
      largest = support::largest_of({largest, std::abs(in_cell.fx()[place])});
    for (const std::size_t place : sheets::sites(large))
    {
      EXPECT_NEAR(in_large.fx()[place], in_cell.fx()[original(place)], 1e-12 * largest);
      EXPECT_NEAR(in_large.fy()[place], in_cell.fy()[original(place)], 1e-12 * largest);
    }
    EXPECT_NEAR(in_large.viscous_power(), 9. * in_cell.viscous_power(), 1e-12 * in_large.viscous_power());
    EXPECT_NEAR(elastic_energy(copies, large, material), 9. * elastic_energy(small, cell, material),
                1e-12 * elastic_energy(copies, large, material));
  }
}

} // namespace forces_test
