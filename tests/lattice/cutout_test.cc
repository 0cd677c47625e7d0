// Cut-outs are empty; the remaining rim is free, undamaged, and symmetric.
#include "lattice/cutout.h"

#include <gtest/gtest.h>

#include "lattice/relaxation.h"
#include "lattice/site_fields.h"
#include "tests/lattice/sheets.h"

namespace cutout_test
{

using namespace latcon;

using namespace lattice;

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
    const State state = with(sheet, RoundHole{R}, Eigen::Matrix2d::Identity());
    const Eigen::Vector2d centre(0.5 * sheet.length(), 0.);
    double removed = 0.;
    for (const std::size_t place : sheets::sites(sheet))
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
    State state = with(sheet, Notch{length}, sheets::stretched(1., 1.2));
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
    for (const std::size_t place : sheets::sites(sheet))
      if (sheet.reference(place).x() > length + 0.1 * sheets::spacing)
      {
        EXPECT_EQ(state.removed[place], 0);
      }
    relax(state, sheet, sheets::rubber(), 1e-9 * 5e5 * sheets::spacing);
    for (const std::size_t place : sheets::sites(sheet))
    {
      const std::size_t mirror = sheets::mirrored(sheet, place);
      EXPECT_EQ(state.x[place], state.x[mirror]);
      EXPECT_EQ(state.y[place], -state.y[mirror]);
    }
    // It opens: the lips are farther apart than they would be in the homogeneous state.
    const auto lip = [&](double Y)
    {
      for (const std::size_t place : sheets::sites(sheet))
        if (state.removed[place] == 0 && state.held[place] == 0 &&
            std::abs(sheet.reference(place).x() - 4. * sheets::spacing) < 0.6 * sheets::spacing &&
            sheet.reference(place).y() * Y > 0. && std::abs(sheet.reference(place).y()) < 1.1 * sheets::spacing)
          return state.y[place] - 1.2 * sheet.reference(place).y();
      return 0.;
    };
    EXPECT_GT(lip(1.), 0.2 * sheets::spacing);
    EXPECT_LT(lip(-1.), -0.2 * sheets::spacing);
  }
}

// A free rim carries no load: the stress there is along it.
TEST(Cutout, RelaxedHoleConcentratesStretchAtItsRim)
{
  const TriangularLattice sheet = sheets::square(60.);
  const Eigen::Matrix2d F = sheets::stretched(1., 1.05);
  State state = with(sheet, RoundHole{6. * sheets::spacing}, F);
  relax(state, sheet, sheets::rubber(), 1e-10 * 5e5 * sheets::spacing);
  const SiteFields fields = site_fields(state, sheet, sheets::rubber());
  const SiteFields whole =
    site_fields(homogeneous_state(sheet, sheets::rubber(), F, Edges::held), sheet, sheets::rubber());
  double beside = 0., above = 1.;
  const std::size_t middle = sheet.rows() / 2;
  for (std::size_t column = 0; column < sheet.columns(); ++column)
  {
    const std::size_t place = sheet.index(middle, column);
    const double x = std::abs(sheet.reference(place).x() - 0.5 * sheet.length()) / sheets::spacing;
    if (x > 6.9 && x < 8.1)
      beside = fields.deformation_gradient[place](1, 1);
  }
  for (std::size_t row = middle; row < sheet.rows(); ++row)
  {
    const std::size_t place = sheet.index(row, sheet.columns() / 2);
    const double y = sheet.reference(place).y() / sheets::spacing;
    if (y > 6.9 && y < 8.5)
      above = std::min(above,
                       fields.first_piola_stress[place](1, 1) / whole.first_piola_stress[sheet.index(middle, 5)](1, 1));
  }
  EXPECT_GT(beside - 1., 0.075); // stretched half as much again at least; three times at the rim of an endless sheet
  EXPECT_LT(beside - 1., 0.2);
  EXPECT_LT(above, 0.5); // in the shadow of the hole
}

} // namespace cutout_test
