// Sheets of any stencil: the lattice's own crack by the stencil of six directions, and what holds for all.
#include "lattice/stencil_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <omp.h>

#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

namespace lattice_stencil_sheet_test
{

using namespace latcon::lattice;

constexpr double d = sheets::spacing;

Eigen::Matrix2d loaded()
{
  return Eigen::Vector2d(2.3, 2.8).asDiagonal();
}

std::vector<Ring> rings(double half_width = M_PI / 6.)
{
  return lattice_rings(d, Orientation::rows_along_crack, half_width);
}

StencilSheet sheet(const Grid &grid, double length, double height, const Eigen::Matrix2d &F = loaded())
{
  return {grid, {0., 0.}, length, height, sheets::rubber(), d, rings(), F, 0.};
}

template <class Work> // work(place)
void for_each_point(const StencilSheet &sheet, const Work &work)
{
  for (int row = -300; row < 300; ++row)
    for (int column = -300; column < 300; ++column)
      if (const auto place = sheet.place(column, row))
        work(*place);
}

using Vectors = std::vector<std::pair<double, double>>;

Vectors midpoints(const std::vector<BrokenBond> &bonds)
{
  Vectors points; // to a thousandth of a spacing
  for (const BrokenBond &bond : bonds)
    points.emplace_back(std::round(1e3 * bond.midpoint.x() / d), std::round(1e3 * bond.midpoint.y() / d));
  std::sort(points.begin(), points.end());
  return points;
}

// Same bonds at the same steps; sums are in another order, hence not the same bits.
TEST(StencilSheet, OfSixDirectionsCracksAsTheLattice)
{
  const TriangularLattice lattice(d, 70. * d, 40. * 0.866 * d, Orientation::rows_along_crack);
  ASSERT_EQ((lattice.rows() - 1) / 2 % 2, 0u); // so that the row at Y = 0 begins at X = 0
  StencilSheet ours({Grid::Kind::triangular, d, 0.}, {0., 0.}, lattice.length(), lattice.height(), sheets::rubber(), d,
                    rings(0.), loaded(), 0.);
  ASSERT_EQ(ours.n_sites(), lattice.n_sites());
  const RowPartition band(lattice);
  const BehindTipToughening toughening{8. * d, 1.6};
  const TimeStepping stepping(ours.resolving_step(), ours.stages());
  Simulation theirs(band, sheets::rubber(), homogeneous_state(band, sheets::rubber(), loaded(), Edges::held), stepping,
                    Fracture(band, sheets::rubber(), 3.05, toughening, loaded()));
  ours.let_break(3.05, toughening);

  const double from = 10. * d, to = 25. * d, Y = 0.2 * d;
  std::vector<std::pair<std::size_t, std::size_t>> crossing;
  for_each_bond(theirs.state(), lattice,
                [&](const Bond &bond)
                {
                  const Eigen::Vector2d X = lattice.reference(bond.near), R = lattice.bond_vector(bond.kind);
                  const double share = (Y - X.y()) / R.y();
                  if (share > 0. && share <= 1. && X.x() + share * R.x() >= from && X.x() + share * R.x() <= to)
                    crossing.emplace_back(bond.near, bond.kind);
                });
  theirs.cut_bonds(crossing);
  EXPECT_EQ(ours.cut(from, to, Y), crossing.size());

  std::size_t n_broken = 0;
  for (int step = 0; step < 300; ++step)
  {
    const Vectors expected = midpoints(theirs.step());
    ASSERT_EQ(midpoints(ours.step()), expected) << "step " << step;
    n_broken += expected.size();
    ASSERT_EQ(ours.tip().has_value(), theirs.tip().has_value());
    ASSERT_LT((ours.reference(*ours.tip()) - lattice.reference(*theirs.tip())).norm(), 1e-9 * d) << "step " << step;
  }
  EXPECT_GT(n_broken, 100u);
  const EnergyBalance a = ours.energies(), b = theirs.energies();
  for (const auto part : {&EnergyBalance::elastic, &EnergyBalance::kinetic, &EnergyBalance::viscous,
                          &EnergyBalance::broken, &EnergyBalance::initial})
    EXPECT_NEAR(a.*part, b.*part, 1e-9 * b.*part);
}

const Grid grids[] = {{Grid::Kind::triangular, d / 2., 0.},
                      {Grid::Kind::square, d / 2., 0.},
                      {Grid::Kind::square, d / 2., M_PI / 4.},
                      {Grid::Kind::triangular, d / 1.5, 0.3},
                      {Grid::Kind::triangular, d / 4., 0.1}}; // of 75 half-bonds, more than a word has

TEST(StencilSheet, RestsWhereItIsStretchedHomogeneously)
{
  Eigen::Matrix2d F;
  F << 1.4, 0.3, -0.2, 1.7;
  for (const Grid &grid : grids)
  {
    StencilSheet at_rest = sheet(grid, 16. * d, 12. * d, F);
    for (int step = 0; step < 20; ++step)
      at_rest.step();
    std::size_t n_free = 0;
    for_each_point(at_rest,
                   [&](std::size_t place)
                   {
                     n_free += at_rest.held(place) ? 0 : 1;
                     EXPECT_LT((at_rest.position(place) - F * at_rest.reference(place)).norm(), 1e-11 * d);
                   });
    EXPECT_GT(n_free, 100u);
  }
}

// With the order of the method, and so only if forces are the gradient of the energy and dashpots take what they say.
TEST(StencilSheet, ClosesItsLedger)
{
  for (const Grid &grid : grids)
  {
    const double span = 8. * sheet(grid, 16. * d, 12. * d).resolving_step();
    const auto relative_imbalance = [&](int steps)
    {
      StencilSheet moving(grid, {0., 0.}, 16. * d, 12. * d, sheets::rubber(), d, rings(), loaded(), span / steps);
      moving.add_noise(0.02 * d, 3);
      for (int step = 0; step < steps; ++step)
        moving.step();
      const EnergyBalance energies = moving.energies();
      return std::abs(energies.imbalance()) / energies.viscous;
    };
    const double coarse = relative_imbalance(64), fine = relative_imbalance(256);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(coarse / fine, 10.);
  }
}

TEST(StencilSheet, HasTheSameBitsOnAllThreadsAndInstructionSets)
{
  const int threads = omp_get_max_threads();
  const std::string best = kernels::instruction_set();
  const auto run = [](int n, const std::string &set)
  {
    omp_set_num_threads(n);
    kernels::use_instruction_set(set);
    StencilSheet crack = sheet({Grid::Kind::square, d / 2., 0.1}, 50. * d, 30. * d);
    EXPECT_GE(crack.n_sites(), min_places_for_threads);
    crack.add_noise(0.02 * d, 3);
    crack.let_break(3.05, {4. * d, 1.6});
    crack.cut(8. * d, 20. * d, 0.1 * d);
    std::size_t broken = 0;
    for (int step = 0; step < 40; ++step)
      broken += crack.step().size();
    EXPECT_GT(broken, 0u);
    std::vector<double> values{crack.energies().elastic, crack.energies().kinetic, crack.energies().viscous,
                               crack.energies().broken};
    for_each_point(crack,
                   [&](std::size_t place)
                   {
                     values.push_back(crack.position(place).x());
                     values.push_back(crack.position(place).y());
                   });
    return values;
  };
  const std::vector<double> expected = run(1, best);
  for (const int n : {2, 3})
    EXPECT_EQ(run(n, best), expected) << n << " threads";
  for (const std::string &set : kernels::instruction_sets())
    EXPECT_EQ(run(1, set), expected) << set;
  omp_set_num_threads(threads);
  kernels::use_instruction_set(best);
}

TEST(StencilSheet, CutsTheBondsThatCrossASegment)
{
  const auto side = [](const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
  { return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0.; };
  for (const Grid &grid : grids)
  {
    StencilSheet slit = sheet(grid, 16. * d, 12. * d), whole = sheet(grid, 16. * d, 12. * d);
    const Eigen::Vector2d a(4.03 * d, 0.217 * d), b(8.41 * d, 0.217 * d);
    std::size_t expected = 0;
    const std::size_t n = slit.cut(a.x(), b.x(), a.y());
    for_each_point(whole,
                   [&](std::size_t place)
                   {
                     for (std::size_t k = 0; k < whole.stencil().size(); ++k)
                     {
                       const Eigen::Vector2d X = whole.reference(place), far = X + whole.stencil()[k].vector;
                       const bool crosses = side(a, b, X) != side(a, b, far) && side(X, far, a) != side(X, far, b);
                       EXPECT_EQ(slit.present(place, k), whole.present(place, k) && !crosses);
                       expected += crosses && whole.present(place, k) ? 1 : 0;
                     }
                   });
    EXPECT_EQ(n, expected);
    EXPECT_GT(n, 0u);
    EXPECT_EQ(slit.stencil().size() > 64, &grid == &grids[4]);
    const EnergyBalance energies = slit.energies();
    EXPECT_NEAR(energies.broken, whole.energies().elastic - energies.elastic, 1e-12 * energies.elastic);
    // The bonds behind the last points with a quarter lost.
    ASSERT_TRUE(slit.tip());
    EXPECT_LT(slit.reference(*slit.tip()).x(), b.x());
    EXPECT_GT(slit.reference(*slit.tip()).x(), b.x() - d);
  }
}

TEST(StencilSheet, RefusesWhatItCannotDo)
{
  const auto refuses = [](const Material &material, double length, double step = 0.)
  {
    EXPECT_THROW(
      StencilSheet({Grid::Kind::square, d / 2., 0.}, {0., 0.}, length, 12. * d, material, d, rings(), loaded(), step),
      std::invalid_argument);
  };
  refuses(sheets::nearest_only(), 16. * d);
  refuses(sheets::rubber_with_memory(), 16. * d);
  refuses(sheets::disordered_rubber(), 16. * d);
  refuses(sheets::rubber(0.), 16. * d);
  refuses(sheets::rubber(), 2. * d); // held points alone
  refuses(sheets::rubber(), 1e6 * d);
  refuses(sheets::rubber(), 16. * d, -1.);
  StencilSheet ours = sheet(grids[0], 16. * d, 12. * d);
  EXPECT_THROW(ours.let_break(0., {d, 1.6}), std::invalid_argument);
  EXPECT_THROW(ours.let_break(3., {d, 0.9}), std::invalid_argument);
  EXPECT_THROW(ours.let_break(3., {-d, 1.6}), std::invalid_argument);
}

} // namespace lattice_stencil_sheet_test
