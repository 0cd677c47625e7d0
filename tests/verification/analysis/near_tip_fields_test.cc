#include "verification/analysis/near_tip_fields.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/sheets.h"
#include "verification/analysis/near_tip_measurement.h"

namespace near_tip_fields_test
{

using namespace latcon;

using namespace lattice;
using namespace analysis;

constexpr double d = sheets::spacing;
const Eigen::Matrix2d loading = sheets::stretched(2.3, 2.8);

/// Sheet of 40 x 30 spacings with a slit along y = 0 that ends at `tip`; tests prescribe the positions of its sites.
struct SlitSheet
{
  TriangularLattice sheet;
  Material material;
  State state;
  std::size_t tip;

  explicit SlitSheet(Orientation orientation = Orientation::rows_along_crack, const Material &rubber = sheets::rubber(),
                     const Eigen::Matrix2d &F = loading)
    : sheet(d, 40 * d, 30 * d, orientation), material(rubber),
      state(homogeneous_state(sheet, material, F, Edges::free)),
      tip(orientation == Orientation::rows_along_crack ? sheet.index(sheet.rows() / 2, 20)
                                                       : sheet.index(20, sheet.columns() / 2))
  {
  }

  NearTipOptions options() const { return {12 * d, 10 * d, 9 * d, 0., sheet.length(), loading}; }

  /// Moves the sites to x(X) with velocities v(X), X relative to the tip.
  template <typename Position, typename Velocity>
  void set(const Position &position, const Velocity &velocity)
  {
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      if (sheet.is_site(place))
      {
        const Eigen::Vector2d X = sheet.reference(place) - sheet.reference(tip);
        const Eigen::Vector2d x = position(X), v = velocity(X);
        state.position.set(place, x);
        state.velocity.set(place, v);
      }
  }

  void break_bond(std::size_t near, std::size_t kind)
  {
    state.bonds.remove(near, kind);
    ++state.lost_bonds[near];
    ++state.lost_bonds[sheet.bond(near, kind).far];
  }
};

// Affine velocities and a quadratic deformation are exact at every point of the grid, also between sites.
using NearTipFieldsOf = testing::TestWithParam<Orientation>;

TEST_P(NearTipFieldsOf, LinearFieldsAreExact)
{
  SlitSheet slit(GetParam());
  Eigen::Matrix2d L;
  L << 1., 2., -3., 4.;
  L *= 1e3;
  const Eigen::Vector2d drift(7., -5.);
  slit.set([](const Eigen::Vector2d &X) -> Eigen::Vector2d { return loading * X; },
           [&](const Eigen::Vector2d &X) -> Eigen::Vector2d { return drift + L * X; });
  NearTipSampler sampler(slit.sheet, slit.material, slit.options());
  ASSERT_NE(sampler.sample(slit.state, slit.tip), nullptr);
  const NearTipField field = sampler.plain();
  const NearTipGrid &grid = field.grid;
  EXPECT_NEAR(grid.pitch_X * grid.pitch_Y, slit.sheet.site_area(), 1e-12 * d * d);
  EXPECT_EQ(grid.behind, static_cast<int>(12 * d / grid.pitch_X + 1e-9));
  const Eigen::Matrix2d P = site_values(slit.state, slit.sheet, slit.material, slit.tip).first_piola_stress;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= grid.ahead; ++i)
    {
      const std::size_t point = grid.point(i, j);
      const Eigen::Vector2d X = grid.reference(i, j);
      ASSERT_NEAR(field.occupancy[point], 1., 1e-15);
      EXPECT_NEAR((field.velocity[point] - drift - L * X).norm(), 0., 1e-12 * L.norm() * 40 * d);
      EXPECT_NEAR((field.position(i, j) - loading * X).norm(), 0., 1e-13 * 40 * d);
      EXPECT_NEAR((field.deformation_gradient[point] - loading).norm(), 0., 1e-12);
      EXPECT_NEAR((field.first_piola_stress[point] - P).norm(), 0., 1e-10 * P.norm());
      // Round-off of positions divided by d^2.
      EXPECT_NEAR(field.strain_gradient_x[point].norm() + field.strain_gradient_y[point].norm(), 0., 1e-12 / d);
    }
}

INSTANTIATE_TEST_SUITE_P(BothOrientations, NearTipFieldsOf,
                         testing::Values(Orientation::rows_along_crack, Orientation::rows_across_crack));

// Also where half the neighbours are missing. theory.md, eq. (N.2).
TEST(StrainGradientFit, IsExactForQuadraticDisplacements)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
    for (const bool both_shells : {true, false})
    {
      SlitSheet slit(orientation, both_shells ? sheets::rubber() : sheets::nearest_only());
      Eigen::Matrix2d Gx, Gy;
      Gx << 30., -20., -20., 50.;
      Gy << -10., 40., 40., 15.;
      const auto x = [&](const Eigen::Vector2d &X) -> Eigen::Vector2d
      { return loading * X + 0.5 * Eigen::Vector2d(X.dot(Gx * X), X.dot(Gy * X)); };
      slit.set(x, [](const Eigen::Vector2d &) -> Eigen::Vector2d { return Eigen::Vector2d::Zero(); });
      StrainGradientFit fit(slit.sheet);
      std::vector<std::size_t> places{slit.tip};
      if (both_shells)
        places.push_back(slit.sheet.index(0, 7)); // at the free edge
      for (const std::size_t place : places)
      {
        const auto G = fit.at(slit.state, place);
        ASSERT_TRUE(G);
        // Round-off of positions, 1e-16 of the sheet, divided by d^2; the largest weight is of order 1.
        EXPECT_NEAR((G->x - Gx).norm() + (G->y - Gy).norm(), 0., 1e-14 * 100. * 40. / d);
      }
      if (!both_shells)
      {
        EXPECT_FALSE(fit.at(slit.state, slit.sheet.index(0, 7)));
      }
    }
}

// If the tip consists of two sites above each other, the axis is between them: the state equals its mirror image.
TEST(NearTipSampler, AxisOfAMirrorSymmetricStateIsItsMirror)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    SlitSheet slit(orientation);
    // Sites above and below the middle, at the same X, each with three lost bonds.
    const bool along = orientation == Orientation::rows_along_crack;
    const std::size_t step = along ? slit.sheet.stride() : 1;
    const std::size_t low = slit.tip - step, high = slit.tip + step;
    slit.state.lost_bonds[low] = slit.state.lost_bonds[high] = 3;
    const Eigen::Vector2d axis = 0.5 * (slit.sheet.reference(low) + slit.sheet.reference(high));
    for (std::size_t place = 0; place < slit.sheet.n_places(); ++place)
      if (slit.sheet.is_site(place))
      {
        const Eigen::Vector2d X = (slit.sheet.reference(place) - axis) / d;
        slit.state.velocity.x[place] = std::cos(X.y()) * (1. + X.x());
        slit.state.velocity.y[place] = std::sin(X.y()) * X.x();
      }
    for (const std::size_t tip : {low, high})
    {
      NearTipSampler sampler(slit.sheet, slit.material, slit.options());
      const NearTipSample *sample = sampler.sample(slit.state, tip);
      ASSERT_NE(sample, nullptr);
      EXPECT_NEAR(sample->Y, 0., 1e-15 * d);
      // Cosines and sines of opposite arguments, which have round-off.
      EXPECT_LT(*velocity_asymmetry(sampler.plain()), 1e-12);
      // With an axis that is shifted by half the distance of the two sites, the state is not symmetric.
      slit.state.lost_bonds[high] = 2;
      NearTipSampler beside(slit.sheet, slit.material, slit.options());
      beside.sample(slit.state, low);
      EXPECT_GT(*velocity_asymmetry(beside.plain()), 0.1);
      slit.state.lost_bonds[high] = 3;
    }
  }
}

// A velocity that always points to the left of the path keeps its side in the folded mean, and cancels in the plain
// mean.
TEST(NearTipSampler, FoldsWhereThePathDescends)
{
  SlitSheet slit(Orientation::rows_along_crack, sheets::rubber());
  const TriangularLattice long_sheet(d, 160 * d, 40 * d, Orientation::rows_along_crack);
  State state = homogeneous_state(long_sheet, slit.material, loading, Edges::free);
  const double amplitude = 5 * d, wavelength = 40 * d, middle = static_cast<double>(long_sheet.rows() / 2);
  NearTipOptions options{8 * d, 8 * d, 8 * d, 30 * d, 110 * d, loading};
  NearTipSampler sampler(long_sheet, slit.material, options);
  for (std::size_t column = 10; column < 140; ++column)
  {
    const double turn = 2. * M_PI * static_cast<double>(column) * d / wavelength;
    const double row = std::round(middle + amplitude * std::sin(turn) / (std::sqrt(0.75) * d));
    const std::size_t tip = long_sheet.index(static_cast<std::size_t>(row), column);
    const double sense = std::cos(turn) > 0. ? 1. : -1.; // ascending or descending
    for (std::size_t place = 0; place < long_sheet.n_places(); ++place)
      if (long_sheet.is_site(place))
        state.velocity.y[place] = sense;
    sampler.sample(state, tip);
  }
  sampler.finish();
  EXPECT_EQ(sampler.samples(), 80u); // columns 30 to 110 in rows without or with an offset of half a spacing
  const NearTipField plain = sampler.plain(), folded = sampler.folded();
  EXPECT_EQ(folded.samples, sampler.samples());
  // The path is on rows of sites, so each of the four turning points is known to two columns: 8 of 80 samples may have
  // the wrong sign.
  EXPECT_LT(std::abs(plain.velocity[plain.grid.point(0, 3)].y()), 0.2);
  EXPECT_GT(folded.velocity[folded.grid.point(0, 3)].y(), 0.8 - 1e-12);
  EXPECT_EQ(folded.velocity[folded.grid.point(0, 3)].x(), 0.);
  std::size_t in_blocks = 0;
  for (std::size_t block = 0; block < NearTipSampler::n_blocks; ++block)
    in_blocks += sampler.folded_block(block).samples();
  EXPECT_EQ(in_blocks, sampler.samples());
}

// Two reflections have no effect; under one reflection the sign of a component is that of its number of indices y.
TEST(NearTipSums, MirrorComponents)
{
  NearTipGrid grid{d, d, d, 2, 2, 2};
  NearTipSums one(grid), once(grid), twice(grid);
  const NearTipSums::Values motion = NearTipSums::Values::LinSpaced(6, 1., 6.);
  const NearTipSums::Values tensors = NearTipSums::Values::LinSpaced(12, 7., 18.);
  const NearTipSums::Values gradients = NearTipSums::Values::LinSpaced(6, 1., 6.);
  one.add_sample();
  one.add_site(2, 3, {motion, tensors, gradients}); // half-way between the points (1, 1) and (1, 2)
  once.add(one, true);
  twice.add(once, true);
  const NearTipField f = one.mean(), m = once.mean(), back = twice.mean();
  for (const int j : {1, 2})
  {
    const std::size_t p = grid.point(1, j), q = grid.point(1, -j);
    EXPECT_EQ(f.occupancy[p], 0.5);
    EXPECT_EQ(m.occupancy[q], 0.5);
    EXPECT_TRUE(std::isnan(m.velocity[p].x()));
    const Eigen::Matrix2d mirror = sheets::stretched(1., -1.);
    EXPECT_EQ(m.velocity[q], mirror * f.velocity[p]);
    EXPECT_EQ(m.displacement[q], mirror * f.displacement[p]);
    EXPECT_EQ(m.excess_displacement[q], mirror * f.excess_displacement[p]);
    EXPECT_EQ(m.deformation_gradient[q], mirror * f.deformation_gradient[p] * mirror);
    EXPECT_EQ(m.first_piola_stress[q], mirror * f.first_piola_stress[p] * mirror);
    EXPECT_EQ(m.cauchy_stress[q], mirror * f.cauchy_stress[p] * mirror);
    EXPECT_EQ(m.strain_gradient_x[q], mirror * f.strain_gradient_x[p] * mirror);
    EXPECT_EQ(m.strain_gradient_y[q], -(mirror * f.strain_gradient_y[p] * mirror));
    EXPECT_EQ(back.velocity[p], f.velocity[p]);
    EXPECT_EQ(back.strain_gradient_y[p], f.strain_gradient_y[p]);
  }
}

// Samples without tensors do not affect the means over samples with tensors.
TEST(NearTipSums, TensorsAreMeansOverTheSamplesThatHaveThem)
{
  NearTipGrid grid{d, d, d, 2, 2, 2};
  NearTipSums with(grid), without(grid), all(grid);
  const NearTipSums::Values tensors = NearTipSums::Values::LinSpaced(12, 7., 18.);
  with.add_sample();
  with.add_site(2, 2, {NearTipSums::Values::Constant(6, 3.), tensors, {}});
  without.add_sample();
  without.add_site(2, 2, {NearTipSums::Values::Constant(6, 1.), {}, {}});
  const std::size_t point = grid.point(1, 1);
  EXPECT_TRUE(std::isnan(without.mean().cauchy_stress[point](0, 0)));
  for (const NearTipSums *sums : {&with, &without, &without})
    all.add(*sums, false);
  const NearTipField mean = all.mean();
  EXPECT_EQ(mean.samples, 3u);
  EXPECT_EQ(mean.occupancy[point], 1.);
  EXPECT_DOUBLE_EQ(mean.velocity[point].x(), 5. / 3.);
  EXPECT_EQ(mean.deformation_gradient[point](0, 0), 7.);
  EXPECT_EQ(mean.cauchy_stress[point](1, 1), 18.);
  EXPECT_TRUE(std::isnan(mean.strain_gradient_x[point](0, 0)));
}

// A site with fewer than half its bonds is debris, and a tip at rest is not a running crack.
TEST(NearTipSampler, LeavesOutDebrisAndTipsAtRest)
{
  SlitSheet slit;
  const std::size_t debris = slit.tip + 2;
  for (std::size_t kind = 0; kind < 2 * n_kinds_per_shell; ++kind)
  {
    slit.break_bond(debris, kind);
    if (kind == 0) // one bond of the other half
      slit.break_bond(slit.sheet.bond_into(debris, 0).near, 0);
  }
  NearTipSampler sampler(slit.sheet, slit.material, slit.options());
  std::size_t taken = 0;
  for (int call = 0; call < 30; ++call)
    taken += sampler.sample(slit.state, slit.tip) != nullptr ? 1 : 0;
  EXPECT_EQ(taken, 10u);
  EXPECT_EQ(sampler.samples(), taken);
  const NearTipField field = sampler.plain();
  EXPECT_EQ(field.occupancy[field.grid.point(2, 0)], 0.);
  EXPECT_EQ(field.occupancy[field.grid.point(3, 0)], 1.);
  EXPECT_FALSE(field.holds(2, 0));

  NearTipOptions elsewhere = slit.options();
  elsewhere.X_end = 10 * d;
  NearTipSampler waiting(slit.sheet, slit.material, elsewhere);
  EXPECT_EQ(waiting.sample(slit.state, slit.tip), nullptr);
  elsewhere.ahead = 0.;
  EXPECT_THROW(NearTipSampler(slit.sheet, slit.material, elsewhere), std::invalid_argument);
}

} // namespace near_tip_fields_test
