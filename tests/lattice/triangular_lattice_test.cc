#include "lattice/triangular_lattice.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/sheets.h"

namespace triangular_lattice_test
{

using namespace latcon;

using lattice::Orientation;
using lattice::TriangularLattice;

using BothOrientations = testing::TestWithParam<Orientation>;
INSTANTIATE_TEST_SUITE_P(TriangularLattice, BothOrientations,
                         testing::Values(Orientation::rows_along_crack, Orientation::rows_across_crack));

// Six neighbours at d, six at sqrt3 d and six at 2 d, no other: compared with all pairs of positions, which know of no
// index.
TEST_P(BothOrientations, SitesHaveSixNeighboursAtEachOfTheRightDistances)
{
  const TriangularLattice sheet = sheets::square(12, GetParam());
  const lattice::Material material = sheets::rubber_of_three_shells();
  const lattice::State state =
    lattice::homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), lattice::Edges::free);
  const std::vector<std::size_t> sites = sheet.sites();
  ASSERT_EQ(sites.size(), sheet.n_sites());

  std::size_t interior = 0;
  for (const std::size_t site : sites)
  {
    std::array<std::size_t, lattice::n_shells> expected{}, bonds{};
    for (const std::size_t other : sites)
    {
      const double distance = (sheet.reference(other) - sheet.reference(site)).norm() / sheets::spacing;
      expected[0] += std::abs(distance - 1.) < 1e-9;
      expected[1] += std::abs(distance - std::sqrt(3.)) < 1e-9;
      expected[2] += std::abs(distance - 2.) < 1e-9;
    }
    lattice::for_each_bond_of_site(state, sheet, site,
                                   [&](const lattice::Bond &bond)
                                   {
                                     EXPECT_TRUE(bond.near == site || bond.far == site);
                                     const Eigen::Vector2d R = sheet.reference(bond.far) - sheet.reference(bond.near);
                                     EXPECT_NEAR((R - sheet.bond_vector(bond.kind)).norm(), 0., 1e-15);
                                     EXPECT_NEAR(R.norm(), sheet.rest_length(bond.kind), 1e-15);
                                     ++bonds[lattice::shell_of(bond.kind)];
                                   });
    EXPECT_EQ(bonds, expected);
    interior += bonds[0] + bonds[1] + bonds[2] == material.coordination();
  }
  EXPECT_GT(interior, sites.size() / 3);
  EXPECT_EQ(material.coordination(), 18u);
}

TEST_P(BothOrientations, ExtentIsThatOfTheOutermostSites)
{
  const TriangularLattice sheet(sheets::spacing, 0.02, 0.01, GetParam());
  // Rounded to whole rows: at most half a pitch off along x, a whole one along y, where the number of rows is odd.
  EXPECT_NEAR(sheet.length(), 0.02, 0.5 * sheets::spacing);
  EXPECT_NEAR(sheet.height(), 0.01, sheets::spacing);
  Eigen::Vector2d low(1., 1.), high(-1., -1.);
  for (const std::size_t place : sheet.sites())
  {
    low = low.cwiseMin(sheet.reference(place));
    high = high.cwiseMax(sheet.reference(place));
  }
  EXPECT_EQ(low.x(), 0.);
  EXPECT_NEAR(high.x(), sheet.length(), 1e-15);
  EXPECT_NEAR(high.y() - low.y(), sheet.height(), 1e-15);
  EXPECT_EQ(high.y(), -low.y());
}

// Held edges are those that are asked for, where the sheet is not periodic.
TEST_P(BothOrientations, HeldSitesAreThoseAtTheEdges)
{
  using lattice::Edges;
  using lattice::Periodic;
  for (const auto &[periodic, held] : {std::pair(Periodic{true, false}, Edges::held),
                                       {Periodic{false, true}, Edges::held},
                                       {Periodic{}, Edges{false, true, false, false}}})
  {
    const double side = 12. * sheets::spacing;
    const TriangularLattice sheet(sheets::spacing, side, side, GetParam(), periodic);
    const lattice::State state = lattice::homogeneous_state(sheet, sheets::rubber(), Eigen::Matrix2d::Identity(), held);
    for (const std::size_t place : sheet.sites())
    {
      const Eigen::Vector2d X = sheet.reference(place);
      const double from_right = sheet.length() - X.x();
      const double from_edge = periodic.x   ? 0.5 * sheet.height() - std::abs(X.y())
                               : periodic.y ? std::min(X.x(), from_right)
                                            : from_right;
      // Bonds reach sqrt3 d across rows that run along the edge, 1.5 d across those that do not.
      EXPECT_EQ(state.held[place] != 0, from_edge < 1.4 * sheets::spacing);
    }
  }
}

TEST(TriangularLattice, RefusesWhatIsNoSheet)
{
  EXPECT_THROW(TriangularLattice(0., 1., 1., Orientation::rows_along_crack), std::invalid_argument);
  EXPECT_THROW(TriangularLattice(1., -1., 1., Orientation::rows_along_crack), std::invalid_argument);
  EXPECT_THROW(TriangularLattice(1., 0.3, 1., Orientation::rows_along_crack), std::invalid_argument);
  EXPECT_THROW(TriangularLattice(1., 1e10, 4., Orientation::rows_along_crack), std::invalid_argument);
  EXPECT_THROW(TriangularLattice(1., 4., HUGE_VAL, Orientation::rows_along_crack), std::invalid_argument);
}

} // namespace triangular_lattice_test
