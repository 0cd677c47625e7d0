#include "verification/analysis/damage_contour.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace damage_contour_test
{

using namespace latcon::analysis;

constexpr double d = 0.625e-3, length = 0.08, height = 0.06, seed = 0.01, X_end = 0.07;

// Damage of a crack along a line at the distance `y`, of the length xi = d (theory-damage.md, eq. (C.67)).
double profile(double y)
{
  const double left = std::max(0., 1. - std::abs(y) / (2. * d));
  return left * left;
}

// Crack with a straight path and the damage `beside` it, on cells of the size d / `cells`.
struct Crack
{
  Crack(const std::function<double(double, double)> &beside, double cells)
  {
    const double h = d / cells;
    const auto n = [h](double size) { return static_cast<std::size_t>(std::lround(size / h)) + 1; };
    image = {n(length), n(height), h, h, -0.5 * height, &nodal};
    for (std::size_t j = 0; j < image.rows; ++j)
      for (std::size_t i = 0; i < image.columns; ++i)
      {
        const double X = static_cast<double>(i) * h, Y = image.bottom + static_cast<double>(j) * h;
        nodal.push_back(X > X_end ? 0. : std::max(profile(Y), beside(X, Y)));
      }
  }

  CrackMeasurement measure() const
  {
    std::vector<TipRecord> tip;
    for (double X = seed; X <= X_end; X += d)
      tip.push_back({X / 20., X, 0., X, 0.});
    CrackMeasurementOptions options;
    options.strip_length = length;
    options.lattice_spacing = d;
    options.end_time = tip.back().t;
    options.seed_tip_X = seed;
    const std::vector<ContourColumn> columns = contour(image, seed);
    return measure_path(
      tip, [&](double begin, double end) { return branched_fraction(columns, begin, end, d); }, options);
  }

  std::vector<double> nodal;
  DamageImage image{};
};

// Branches that leave the path at X = 3 cm under 30 degrees.
double branches(double X, double Y)
{
  return X < 0.03 ? 0. : profile((std::abs(Y) - std::tan(M_PI / 6.) * (X - 0.03)) * std::cos(M_PI / 6.));
}

// Specks of damage 16 d above the path, one every 4 d: 1.2 d long and so thin that their edges are 0.4 d apart.
double debris(double X, double Y)
{
  const double along = X / (4. * d) - std::floor(X / (4. * d));
  return along < 0.3 ? 0.75 * profile(0.5 * (Y - 16. * d)) * (std::abs(Y - 16. * d) < 0.2 * d ? 1. : 0.6) : 0.;
}

TEST(DamageContour, ColumnsHaveEdgesAndGapsBetweenStrands)
{
  const Crack crack(branches, 4.);
  for (const ContourColumn &column : contour(crack.image, 0.05))
  {
    EXPECT_EQ(column.n_strands, 3u);
    // Half of the width of the damage above 1/2, across a strand.
    const double half = 2. * d * (1. - std::sqrt(0.5)), distance = std::tan(M_PI / 6.) * (column.X - 0.03);
    EXPECT_NEAR(column.upper, distance + half / std::cos(M_PI / 6.), 0.1 * d);
    EXPECT_NEAR(column.lower, -column.upper, 1e-12);
    EXPECT_NEAR(column.gap, distance - half - half / std::cos(M_PI / 6.), 0.1 * d);
    EXPECT_NEAR(column.damaged, 2. * half * (1. + 2. / std::cos(M_PI / 6.)), 0.3 * d);
  }
}

TEST(DamageContour, BranchesDoNotDependOnTheMesh)
{
  // Where the gap exceeds 10 d, over the length of the crack in the window.
  const double half = 2. * d * (1. - std::sqrt(0.5));
  const double begin = 0.03 + (10. * d + half + half / std::cos(M_PI / 6.)) / std::tan(M_PI / 6.);
  for (const double cells : {2., 4.})
  {
    const CrackMeasurement measured = Crack(branches, cells).measure();
    EXPECT_EQ(measured.pattern, CrackPattern::branching) << cells << ": " << measured.reason;
    EXPECT_NEAR(measured.branched_fraction, (X_end - begin) / (X_end - seed), 0.01) << cells;
  }
}

TEST(DamageContour, DebrisIsNoBranchOnAnyMesh)
{
  for (const double cells : {2., 4.})
  {
    const Crack crack(debris, cells);
    EXPECT_EQ(contour_column(crack.image, static_cast<std::size_t>(std::lround(32.3 * cells)))->n_strands, 2u) << cells;
    const CrackMeasurement measured = crack.measure();
    EXPECT_EQ(measured.pattern, CrackPattern::straight) << cells << ": " << measured.reason;
    EXPECT_EQ(measured.branched_fraction, 0.) << cells;
  }
}

} // namespace damage_contour_test
