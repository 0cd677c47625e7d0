#include "verification/analysis/fragments.h"

#include <array>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

namespace fragments_test
{

using namespace latcon;

using namespace lattice;
using namespace analysis;

// Removes all bonds between a site in `inner` and another site.
void cut_around(State &state, const TriangularLattice &sheet, const std::vector<std::size_t> &inner)
{
  const auto is_inner = [&](std::size_t place)
  { return std::find(inner.begin(), inner.end(), sheet.canonical_place(place)) != inner.end(); };
  for_each_bond(state, sheet,
                [&](const Bond &bond)
                {
                  if (is_inner(bond.near) != is_inner(bond.far))
                    state.bonds.remove(bond.near, bond.kind);
                });
}

class Cut : public testing::Test
{
protected:
  Cut()
    : sheet(sheets::square(16)), material(sheets::rubber()),
      state(homogeneous_state(sheet, material, sheets::stretched(1.2, 1.4), Edges::held))
  {
  }

  TriangularLattice sheet;
  Material material;
  State state;
};

// Three pieces of 1, 3 and 3 sites; larger pieces come first, and of equal ones the piece that starts in the lower row.
TEST_F(Cut, FragmentsAreNumberedByFallingSize)
{
  const std::vector<std::size_t> lone{sheet.index(3, 5)};
  const std::vector<std::size_t> lower{sheet.index(6, 8), sheet.index(6, 9), sheet.index(7, 8)};
  const std::vector<std::size_t> upper{sheet.index(11, 4), sheet.index(11, 5), sheet.index(12, 5)};
  for (const auto &piece : {upper, lone, lower})
    cut_around(state, sheet, piece);
  const Fragments fragments = find_fragments(state, sheet);
  EXPECT_EQ(fragments.sizes, (std::vector<std::size_t>{3, 3, 1}));
  std::vector<std::uint32_t> wanted(sheet.n_places(), 0);
  for (const std::size_t place : lower)
    wanted[place] = 1;
  for (const std::size_t place : upper)
    wanted[place] = 2;
  wanted[lone[0]] = 3;
  EXPECT_EQ(fragments.number, wanted);
}

// A cut through the whole sheet leaves two halves, both held; a removed site is not a fragment.
TEST_F(Cut, HalvesOfTheSheetAreNoFragments)
{
  std::vector<std::size_t> half;
  for (std::size_t row = 0; row < 8; ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
      half.push_back(sheet.index(row, column));
  cut_around(state, sheet, half);
  Fracture fracture(sheet, material, 2., Toughening{}, Eigen::Matrix2d::Identity());
  fracture.remove_sites(state, {sheet.index(10, 6)});
  EXPECT_TRUE(find_fragments(state, sheet).sizes.empty());
}

TEST_F(Cut, WithoutHeldSitesTheLargestPieceIsTheSheet)
{
  state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free);
  cut_around(state, sheet, {sheet.index(0, 0), sheet.index(0, 1)});
  const Fragments fragments = find_fragments(state, sheet);
  EXPECT_EQ(fragments.sizes, std::vector<std::size_t>{2});
  EXPECT_EQ(fragments.number[sheet.index(0, 1)], 1u);
  EXPECT_EQ(fragments.number[sheet.index(5, 5)], 0u);
}

// Pieces are connected across a periodic edge.
TEST(Fragments, GoOnAcrossAPeriodicEdge)
{
  const TriangularLattice sheet(1., 12., 12., Orientation::rows_along_crack, {true, false});
  const Material material = sheets::nearest_only();
  State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  const std::size_t row = 5, last = sheet.columns() - 1;
  cut_around(state, sheet, {sheet.index(row, 0), sheet.index(row, last)});
  EXPECT_EQ(find_fragments(state, sheet).sizes, std::vector<std::size_t>{2});
}

// Bonds beyond the limit of their shell count, regardless of toughening.
TEST_F(Cut, OverstretchedBondsAreThoseThatOnlyTougheningKept)
{
  EXPECT_EQ(n_overstretched_bonds(state, sheet, CriticalStretch(2.)), 0u);
  // One site is moved far up: its bonds are long, independent of their breaking stretch.
  const std::size_t place = sheet.index(8, 8);
  state.position.y[place] += 6. * sheets::spacing;
  std::size_t n = 0;
  for_each_bond_of_site(state, sheet, place, [&](const Bond &) { ++n; });
  EXPECT_EQ(n, 12u);
  EXPECT_EQ(n_overstretched_bonds(state, sheet, CriticalStretch(2.)), 12u);
  EXPECT_EQ(n_overstretched_bonds(state, sheet, CriticalStretch(std::array{2., 20., 2.})), 6u); // of the nearest neighbours
  EXPECT_EQ(n_overstretched_bonds(state, sheet, CriticalStretch(20.)), 0u);
  cut_around(state, sheet, {place});
  EXPECT_EQ(n_overstretched_bonds(state, sheet, CriticalStretch(2.)), 0u);
}

// A crack between two rows, from X = 2 d to 14 d: three strips. The sheet is 16 d long.
TEST_F(Cut, FibrilsBridgeTheStripsTheyAreIn)
{
  const double d = sheets::spacing;
  const auto middle = sheet.rows() / 2;
  const auto crosses = [&](std::size_t near, std::size_t far)
  {
    const std::size_t lower = std::min(sheet.row_of(near), sheet.row_of(far));
    const std::size_t upper = std::max(sheet.row_of(near), sheet.row_of(far));
    return lower <= middle && upper > middle;
  };
  EXPECT_DOUBLE_EQ(bridged_length(state, sheet, 2. * d, 14. * d), 12. * d);
  EXPECT_DOUBLE_EQ(bridged_length(state, sheet, 2. * d, 13.9 * d), 8. * d);
  EXPECT_EQ(bridged_length(state, sheet, 2. * d, 2. * d), 0.);
  std::vector<std::pair<std::size_t, std::size_t>> cut;
  for_each_bond(state, sheet,
                [&](const Bond &bond)
                {
                  if (crosses(bond.near, bond.far))
                    cut.emplace_back(bond.near, bond.kind);
                });
  for (const auto &[near, kind] : cut)
    state.bonds.remove(near, kind);
  EXPECT_EQ(bridged_length(state, sheet, 2. * d, 14. * d), 0.);
  std::swap(state.held, state.rollers); // edges on rollers count as held ones do
  EXPECT_TRUE(find_fragments(state, sheet).sizes.empty());
  // One bond between sites of the strip from 6 d to 10 d bridges only this strip.
  for (const auto &[near, kind] : cut)
  {
    const double X = sheet.reference(near).x() / d;
    if (kind != 1 || X < 7. || X > 8.)
      continue;
    state.bonds.add(near, kind);
    EXPECT_DOUBLE_EQ(bridged_length(state, sheet, 2. * d, 14. * d), 4. * d);
    return;
  }
  FAIL() << "no such bond";
}

} // namespace fragments_test
