// Cut-outs are empty, and the remaining rim is free, undamaged, and symmetric; seeds of cracks.
#include "lattice/cutout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/relaxation.h"
#include "tests/lattice/sheets.h"

namespace cutout_test
{

using namespace latcon;

using namespace lattice;
using sheets::places_in_row;

constexpr Orientation orientations[] = {Orientation::rows_along_crack, Orientation::rows_across_crack};

State with(const TriangularLattice &sheet, const Cutout &cutout, const Eigen::Matrix2d &F)
{
  State state = homogeneous_state(sheet, sheets::rubber(), F, Edges::held);
  cut_out(state, sheet, cutout);
  return state;
}

TEST(Cutout, HoleTakesTheSitesInsideAndTheirBonds)
{
  for (const Orientation orientation : orientations)
  {
    const TriangularLattice sheet = sheets::square(40., orientation);
    const double R = 8. * sheets::spacing;
    const State state = with(sheet, {R, 0.}, Eigen::Matrix2d::Identity());
    const Eigen::Vector2d centre(0.5 * sheet.length(), 0.);
    double removed = 0.;
    for (const std::size_t place : sheet.sites())
    {
      const double distance = (sheet.reference(place) - centre).norm();
      EXPECT_EQ(state.removed[place] != 0, distance < R * (1. - 1e-9));
      EXPECT_EQ(state.lost_bonds[place], 0);
      removed += state.removed[place];
      unsigned int bonds = 0;
      for_each_bond_of_site(state, sheet, place, [&](const Bond &) { ++bonds; });
      if (state.removed[place] != 0)
      {
        EXPECT_EQ(bonds, 0u);
      }
      else if (distance < R + 0.9 * sheets::spacing)
      {
        EXPECT_LT(bonds, 12u);
      }
    }
    // The area of the hole, to the sites that its rim cuts: some 2 pi R / d of them, half of them in.
    EXPECT_NEAR(removed * sheet.site_area(), M_PI * R * R, 0.5 * 2. * M_PI * R * sheets::spacing);
  }
}

TEST(Cutout, NotchLeavesNoBondAcrossItAndKeepsMirrorSymmetry)
{
  for (const Orientation orientation : orientations)
  {
    const TriangularLattice sheet = sheets::square(24., orientation);
    const double length = 9. * sheets::spacing;
    State state = with(sheet, {0., length}, sheets::stretched(1., 1.2));
    for_each_bond(state, sheet,
                  [&](const Bond &bond)
                  {
                    const Eigen::Vector2d X = sheet.reference(bond.near), Y = X + sheet.bond_vector(bond.kind);
                    const bool across = X.y() * Y.y() <= 0. && std::abs(X.y() - Y.y()) > 0.;
                    if (across)
                    {
                      EXPECT_GT(X.x() + (Y.x() - X.x()) * X.y() / (X.y() - Y.y()), length);
                    }
                  });
    // Ahead of the notch everything is there.
    for_each_bond(homogeneous_state(sheet, sheets::rubber(), Eigen::Matrix2d::Identity(), Edges::held), sheet,
                  [&](const Bond &bond)
                  {
                    const double near = sheet.reference(bond.near).x(), far = near + sheet.bond_vector(bond.kind).x();
                    if (std::min(near, far) > length + 0.1 * sheets::spacing)
                    {
                      EXPECT_TRUE(state.bonds.present(bond.near, bond.kind));
                    }
                  });
    relax(state, sheet, sheets::rubber(), 1e-9 * 5e5 * sheets::spacing);
    for (const std::size_t place : sheet.sites())
    {
      const std::size_t mirror = sheets::mirrored(sheet, place);
      EXPECT_EQ(state.position.x[place], state.position.x[mirror]);
      EXPECT_EQ(state.position.y[place], -state.position.y[mirror]);
    }
  }
}

// The sheet and its notch scaled by any factor lose the same sites.
TEST(Cutout, NotchIsTheSameAtEveryScale)
{
  for (const double spacing : {1e-9, 1., 1e9})
  {
    const TriangularLattice sheet(spacing, 24. * spacing, 24. * spacing, Orientation::rows_across_crack);
    const State state = with(sheet, {0., 9. * spacing}, Eigen::Matrix2d::Identity());
    EXPECT_EQ(std::count(state.removed.begin(), state.removed.end(), 1), 6) << spacing;
  }
}

// 21 columns; rows 0 to 22 at Y = (row - 11) sqrt3 / 2, odd ones (the middle among them) shifted by half a spacing.
TriangularLattice along()
{
  return {1., 20., 19.1, Orientation::rows_along_crack};
}

TEST(Seed, LineTakesTheNearestRowFromTheNearestSite)
{
  const TriangularLattice sheet = along();
  ASSERT_EQ(sheet.rows(), 23u);
  EXPECT_EQ(seed_line(sheet, {3.1, 0.}, 4), places_in_row(sheet, 11, 3, 4));  // X = 3.5, 4.5 ...
  EXPECT_EQ(seed_line(sheet, {3., 0.}, 1), places_in_row(sheet, 11, 3, 1));   // as near to 2.5: the larger
  EXPECT_EQ(seed_line(sheet, {3.1, 0.8}, 2), places_in_row(sheet, 12, 3, 2)); // X = 3, 4
  EXPECT_EQ(seed_line(sheet, {3.1, -0.5}, 2), places_in_row(sheet, 10, 3, 2));
  EXPECT_EQ(seed_line(sheet, {3.1, std::sqrt(3.) / 4.}, 2), places_in_row(sheet, 12, 3, 2)); // the larger
}

// Rows run along y, sqrt3 / 2 apart along x; a line along x has a site in every second one.
TEST(Seed, LineAcrossRowsTakesASiteOfEverySecondRow)
{
  const TriangularLattice sheet(1., 20., 20., Orientation::rows_across_crack);
  const std::size_t middle = sheet.columns() / 2;
  ASSERT_EQ(sheet.reference(sheet.index(0, middle)).y(), 0.);
  EXPECT_EQ(seed_line(sheet, {3.4, 0.}, 3),
            (std::vector<std::size_t>{sheet.index(4, middle), sheet.index(6, middle), sheet.index(8, middle)}));
  // Half a spacing up stand the odd rows.
  EXPECT_EQ(seed_line(sheet, {3.4, 0.4}, 2),
            (std::vector<std::size_t>{sheet.index(3, middle), sheet.index(5, middle)}));
}

// Rows 10 to 12 are within 0.9 of Y = 0; X from 4 to 6, ends included.
TEST(Seed, SlitTakesTheSitesOfAClosedRectangle)
{
  const TriangularLattice sheet = along();
  EXPECT_EQ(seed_slit(sheet, {4., -0.9}, {6., 0.9}),
            (std::vector<std::size_t>{sheet.index(10, 4), sheet.index(12, 4), sheet.index(11, 4), sheet.index(10, 5),
                                      sheet.index(12, 5), sheet.index(11, 5), sheet.index(10, 6), sheet.index(12, 6)}));
  EXPECT_EQ(seed_slit(sheet, {4., 0.}, {6., 0.}), places_in_row(sheet, 11, 4, 2));
  EXPECT_EQ(seed_slit(sheet, {4., std::sqrt(3.) / 2.}, {6., std::sqrt(3.) / 2.}), places_in_row(sheet, 12, 4, 3));
}

// In a sheet of 1e12 sites, of which no list can be made.
TEST(Seed, LooksOnlyWhereItIs)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    const TriangularLattice sheet(1., 1e6, 1e6, orientation);
    const std::vector<std::size_t> line = seed_line(sheet, {5e5, 0.}, 4);
    ASSERT_EQ(line.size(), 4u);
    EXPECT_NEAR(sheet.reference(line.front()).x(), 5e5, 1.);
    EXPECT_EQ(sheet.reference(line.front()).y(), 0.);
    const std::vector<std::size_t> slit = seed_slit(sheet, {5e5, -5.}, {5e5 + 10., 5.});
    EXPECT_EQ(slit.size(), 115u);
    const auto X = [&sheet](std::size_t place)
    { return std::pair(sheet.reference(place).x(), sheet.reference(place).y()); };
    EXPECT_TRUE(std::is_sorted(slit.begin(), slit.end(), [&](auto a, auto b) { return X(a) < X(b); }));
    EXPECT_THROW(seed_slit(sheet, {0., -5e4}, {1e6, 5e4}), std::invalid_argument);
  }
}

} // namespace cutout_test
