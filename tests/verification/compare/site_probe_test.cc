#include "verification/compare/site_probe.h"

#include <cmath>

#include <gtest/gtest.h>

#include "frames.h"
#include "support/largest_error.h"
#include "tests/support/temporary_folder.h"

namespace site_probe_test
{

using namespace latcon;

using namespace compare;

ContinuumFrame read(const std::string &path)
{
  return read_continuum_frame(find_frame(path, Side::continuum, {}));
}

constexpr double pi = 3.14159265358979324;

// Maps the unit square to a quarter of an annulus, whose cells have curved sides [m].
std::array<double, 2> annulus(double r, double s)
{
  const double radius = 0.01 + 0.02 * r;
  return {{radius * std::cos(0.5 * pi * s), radius * std::sin(0.5 * pi * s)}};
}

double largest(const FieldValues &field)
{
  double value = 0.;
  for (const double v : field.values)
    value = support::largest_of({value, std::abs(v)});
  return value;
}

TEST(SiteProbe, FindsPolynomialsOfTheDegreeOfItsCells)
{
  TemporaryFolder folder;
  for (int degree = 1; degree <= 4; ++degree)
  {
    MadeUpState state;
    state.displacement = [=](double X, double Y)
    {
      const double x = X / 0.06;
      const double y = Y / 0.04;
      return std::array<double, 2>{{std::pow(x, degree) * std::pow(y, degree) - 2. * x, std::pow(y - 0.3, degree)}};
    };
    const ContinuumFrame frame = read(write_continuum(folder / "a.vtu", state, degree));
    std::vector<Position> points;
    for (int j = 0; j <= 24; ++j)
      for (int i = 0; i <= 36; ++i) // on edges and corners of cells and of the sheet, and between
        points.push_back({{0.06 * i / 36., 0.04 * j / 24.}});
    const SiteValues found = probe(frame, points, 1e-9, MPI_COMM_SELF);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const std::array<double, 2> exact = state.displacement(points[i][0], points[i][1]);
      EXPECT_EQ(found.outside[i], 0);
      EXPECT_NEAR(found.fields[0].at(i)[0], exact[0], 1e-13) << degree;
      EXPECT_NEAR(found.fields[0].at(i)[1], exact[1], 1e-13) << degree;
    }
  }
}

TEST(SiteProbe, InvertsCurvedCells)
{
  // Isoparametric cells represent linear displacements exactly, for any curvature.
  TemporaryFolder folder;
  const ContinuumFrame frame = read(write_continuum(folder / "a.vtu", {}, 3, 2, 4, annulus));
  std::vector<Position> points;
  for (int j = 0; j <= 40; ++j)
    for (int i = 1; i < 20; ++i)
      points.push_back(annulus(i / 20., j / 40.));
  const SiteValues found = probe(frame, points, 1e-9, MPI_COMM_SELF);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ASSERT_EQ(found.outside[i], 0) << points[i][0] << " " << points[i][1];
    EXPECT_NEAR(found.fields[0].at(i)[0], 0.1 * points[i][0] + 0.02 * points[i][1], 1e-16);
    EXPECT_NEAR(found.fields[0].at(i)[1], 0.2 * points[i][1], 1e-16);
  }
}

TEST(SiteProbe, GivesNoValueOutside)
{
  TemporaryFolder folder;
  const ContinuumFrame frame = read(write_continuum(folder / "a.vtu", {}, 3, 2, 4, annulus));
  // In the hole, beyond the rim, and beyond a straight side by less and by more than the tolerance.
  const std::vector<Position> points{
    {{0.005, 0.005}}, {{0.0299, 0.0299}}, {{0.02, -0.9e-6}}, {{0.02, -1.1e-6}}, {{1., 1.}}};
  const SiteValues found = probe(frame, points, 1e-6, MPI_COMM_SELF);
  EXPECT_EQ(found.outside, (std::vector<std::uint8_t>{1, 1, 0, 1, 1}));
  for (const std::size_t i : {0u, 1u, 3u, 4u})
    for (const FieldValues &field : found.fields)
      EXPECT_TRUE(std::isnan(field.at(i)[0]));
  EXPECT_NEAR(found.fields[0].at(2)[1], -0.9e-6 * 0.2, 1e-16); // extrapolated, not constant
}

TEST(SiteProbe, TakesTheMeanWhereFieldsJump)
{
  TemporaryFolder folder;
  ContinuumFrame frame = read(write_continuum(folder / "a.vtu", {}, 2, 2, 1));
  FieldValues &energy = frame.fields.back();
  for (std::size_t i = 0; i < energy.values.size(); ++i)
    energy.values[i] = i < 9 ? 1. : 4.; // of the left and of the right cell
  const SiteValues found =
    probe(frame, {{{0.01, 0.01}}, {{0.03, 0.01}}, {{0.03, 0.}}, {{0.05, 0.02}}}, 1e-9, MPI_COMM_SELF);
  const std::vector<double> wanted{1., 2.5, 2.5, 4.};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(found.fields.back().values[i], wanted[i], 1e-14);
}

TEST(SiteProbe, IsQuickOnManySites)
{
  TemporaryFolder folder;
  const ContinuumFrame frame = read(write_continuum(folder / "a.vtu", {}, 3, 125, 80));
  std::vector<Position> points;
  for (int j = 0; j < 250; ++j)
    for (int i = 0; i < 400; ++i)
      points.push_back({{0.06 * i / 399., 0.04 * j / 249.}});
  const auto start = std::chrono::steady_clock::now();
  const SiteValues found = probe(frame, points, 1e-9, MPI_COMM_SELF);
  // 1e5 sites among 1e4 cells. Measured: 0.3 s; a search over all cells would take minutes.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5.);
  EXPECT_EQ(std::count(found.outside.begin(), found.outside.end(), 0), 100000);
  EXPECT_NEAR(largest(found.fields[0]), 0.2 * 0.04, 1e-12);
}

} // namespace site_probe_test
