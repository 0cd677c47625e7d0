#include "verification/analysis/near_tip_measurement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>

#include <gtest/gtest.h>

namespace near_tip_measurement_test
{

using namespace latcon;

using namespace lattice;
using namespace analysis;

constexpr double d = 1e-3;
constexpr double speed = 50.; // of the crack [m/s]
constexpr double slow = 0.1;  // slower rotations are not vortices [m/s]

/// Returns a field with given velocities (functions of the reference position relative to the tip), and material
/// deformed by F.
template <typename Velocity>
NearTipField field_of(const Velocity &velocity, const Eigen::Matrix2d &F = Eigen::Matrix2d::Identity(),
                      const NearTipGrid &grid_of_points = {d, std::sqrt(0.75) * d, d, 30, 30, 30})
{
  NearTipField field(grid_of_points);
  const NearTipGrid &grid = field.grid;
  field.samples = 1;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= grid.ahead; ++i)
    {
      const std::size_t point = grid.point(i, j);
      const Eigen::Vector2d X = grid.reference(i, j);
      field.occupancy[point] = 1.;
      field.velocity[point] = velocity(X);
      field.displacement[point] = F * X - X;
      field.cauchy_stress[point].setZero();
    }
  return field;
}

/// Removes the material at |Y| < half_width behind the tip.
void open_crack(NearTipField &field, double half_width)
{
  for (int j = -field.grid.half_height; j <= field.grid.half_height; ++j)
    for (int i = -field.grid.behind; i < 0; ++i)
      if (std::abs(field.grid.reference(i, j).y()) < half_width)
      {
        field.occupancy[field.grid.point(i, j)] = 0.;
        field.velocity[field.grid.point(i, j)].setConstant(std::nan(""));
      }
}

Eigen::Vector2d turn(const Eigen::Vector2d &X)
{
  return {-X.y(), X.x()};
}

// Disc of backward motion with radius 5 d, 12 d ahead of the tip.
TEST(NegativeZone, IsTheDiscThatMovesBack)
{
  const Eigen::Vector2d centre(12 * d, 0.);
  const double radius = 5 * d;
  NearTipField field = field_of(
    [&](const Eigen::Vector2d &X) -> Eigen::Vector2d
    {
      const double r = (X - centre).norm();
      return {r < radius ? -4. + 3. * r / radius : -0.4, 0.}; // -4 to -1, and less than 1 % of 50 m/s around
    });
  const NegativeZone zone = negative_zone(field, speed);
  // The area of the disc in cells has an error of a fraction of its rim, 31 of 91 cells.
  EXPECT_NEAR(zone.area, M_PI * radius * radius, 0.15 * M_PI * radius * radius);
  EXPECT_NEAR(zone.length, 9 * d, 1e-9 * d); // centres of cells from 8 to 16 d
  EXPECT_NEAR(*zone.distance, 8 * d, 1e-9 * d);
  EXPECT_DOUBLE_EQ(zone.depth, -4.);
  EXPECT_NEAR((zone.deepest - centre).norm(), 0., 1e-9 * d);
  // Of a sample its backward speeds alone are kept, from which both follow.
  const std::vector<double> speeds = backward_speeds(field);
  const auto fast = std::count_if(speeds.begin(), speeds.end(), [](double v) { return v < -0.01 * speed; });
  EXPECT_NEAR(static_cast<double>(fast) * field.grid.pitch_X * field.grid.pitch_Y, zone.area, 1e-9 * d * d);
  EXPECT_GT(speeds.size(), static_cast<std::size_t>(fast)); // the slow ones around as well
  EXPECT_EQ(*std::min_element(speeds.begin(), speeds.end()), zone.depth);
  // Points behind the tip and points without material do not count.
  for (std::size_t point = 0; point < field.grid.size(); ++point)
    field.occupancy[point] = 0.4;
  EXPECT_EQ(negative_zone(field, speed).area, 0.);
  field = field_of([](const Eigen::Vector2d &X) -> Eigen::Vector2d { return {X.x() > 0.5 * d ? -0.4 : -9., 0.}; });
  const NegativeZone none = negative_zone(field, speed);
  EXPECT_EQ(none.area, 0.);
  EXPECT_FALSE(none.distance);
  EXPECT_DOUBLE_EQ(none.depth, -0.4);
  EXPECT_GT(negative_zone(field, speed, 0.001).area, 0.);
}

// theory.md, eq. (N.3).
TEST(VelocityAsymmetry, OfSymmetricAntisymmetricAndOneSidedFields)
{
  const auto even = [](const Eigen::Vector2d &X) -> Eigen::Vector2d { return {std::abs(X.y()) + X.x(), X.y()}; };
  const auto odd = [](const Eigen::Vector2d &X) -> Eigen::Vector2d { return {X.y(), X.x()}; };
  EXPECT_LT(*velocity_asymmetry(field_of(even)), 1e-15);
  EXPECT_NEAR(*velocity_asymmetry(field_of(odd)), 2., 1e-15);
  const auto one_side = [](const Eigen::Vector2d &X) -> Eigen::Vector2d { return {X.y() > 0. ? 1. : 0., 0.}; };
  EXPECT_NEAR(*velocity_asymmetry(field_of(one_side)), std::sqrt(2.), 1e-15);
  // Points whose mirror image has no material do not count.
  NearTipField half = field_of(odd);
  for (int i = -30; i <= 30; ++i)
    for (int j = 1; j <= 30; ++j)
      half.occupancy[half.grid.point(i, j)] = 0.;
  EXPECT_NEAR(*velocity_asymmetry(half), 2., 1e-12); // v_y on the axis itself
  const auto rest = [](const Eigen::Vector2d &) -> Eigen::Vector2d { return Eigen::Vector2d::Zero(); };
  EXPECT_FALSE(velocity_asymmetry(field_of(rest)));
}

// The circulation of a rigid rotation is 2 omega times the current area of the loop.
TEST(Circulation, OfARigidTurnInTheCurrentConfiguration)
{
  Eigen::Matrix2d F;
  F << 2.3, 0.2, 0., 2.8;
  const double omega = 300., radius = 6 * d;
  const NearTipField field =
    field_of([&](const Eigen::Vector2d &X) -> Eigen::Vector2d { return omega * turn(F * X); }, F);
  // A regular polygon of 72 corners has sin(5 degrees) / (5 degrees) of the circle's area.
  const double area = 36. * std::sin(M_PI / 36.) * radius * radius * F.determinant();
  EXPECT_NEAR(*circulation(field, {3 * d, 2 * d}, radius, false), 2. * omega * area, 1e-9 * omega * area);
  EXPECT_FALSE(circulation(field, {28 * d, 0.}, radius, false)); // leaves the window

  // Around the tip: the part of the loop in the opening is skipped.
  NearTipField cracked = field_of(
    [](const Eigen::Vector2d &X) -> Eigen::Vector2d {
      return {std::abs(X.y()), -X.y()};
    });
  open_crack(cracked, 1.5 * d);
  EXPECT_FALSE(circulation(cracked, {0., 0.}, radius, false));
  EXPECT_NEAR(*circulation(cracked, {0., 0.}, radius, true), 0., 1e-12 * d);
}

TEST(Vortices, AreFoundWithPlaceAndSense)
{
  // Two Gaussian vortices of 3 d with opposite sense; there is no other critical point of index 1.
  const Eigen::Vector2d one(10.3 * d, 8.2 * d), other(10.3 * d, -8.2 * d);
  const double width = 3 * d;
  const auto spin = [&](const Eigen::Vector2d &X, const Eigen::Vector2d &centre) -> Eigen::Vector2d
  { return 20. / width * turn(X - centre) * std::exp(-(X - centre).squaredNorm() / (2. * width * width)); };
  const NearTipField field =
    field_of([&](const Eigen::Vector2d &X) -> Eigen::Vector2d { return spin(X, one) - 0.5 * spin(X, other); });
  const std::vector<Vortex> found = vortices(field, slow);
  ASSERT_EQ(found.size(), 2u);
  const bool first_is_one = found[0].position.y() > 0.;
  const Vortex &a = found[first_is_one ? 0 : 1], &b = found[first_is_one ? 1 : 0];
  EXPECT_NEAR((a.position - one).norm(), 0., 0.05 * d);
  EXPECT_NEAR((b.position - other).norm(), 0., 0.05 * d);
  // 2 pi r v(r) at r = 2 d; linear interpolation between points costs (d / width)^2 / 8 of it, a few percent.
  const double exact = 2. * M_PI * 4. * d * d * 20. / width * std::exp(-4. / 18.);
  EXPECT_NEAR(a.circulation, exact, 0.06 * exact);
  EXPECT_NEAR(b.circulation, -0.5 * exact, 0.03 * exact);
  EXPECT_NEAR(a.speed, a.circulation / (4. * M_PI * d), 1e-12 * a.speed);
  EXPECT_EQ(vortices(field, slow, 15 * d).size(), 2u); // they are at 13.2 d
  EXPECT_EQ(vortices(field, slow, 11 * d).size(), 0u);
  // On a grid of half the spacing the circle is as large.
  const Eigen::Vector2d centre(-5.2 * d, 0.1 * d);
  const auto turning = [&](const Eigen::Vector2d &X) -> Eigen::Vector2d { return turn(X - centre); };
  const NearTipField fine = field_of(turning, Eigen::Matrix2d::Identity(), {0.5 * d, 0.5 * d, d, 60, 60, 60});
  EXPECT_NEAR(vortices(fine, 0.).at(0).circulation, 8. * M_PI * d * d, 0.05 * d * d);
}

TEST(Vortices, AreNeitherNodesNorSaddlesNorSlowNorInTheOpening)
{
  const Eigen::Vector2d centre(-5.2 * d, 0.1 * d);
  const auto around = [&](const Eigen::Matrix2d &L)
  { return field_of([=](const Eigen::Vector2d &X) -> Eigen::Vector2d { return L * (X - centre); }); };
  Eigen::Matrix2d L;
  L << 0., -1e4, 1e4, 0.;
  EXPECT_EQ(vortices(around(L), slow).size(), 1u);
  EXPECT_EQ(vortices(around(1e-3 * L), slow).size(), 0u); // 2 d x 10/s is below 0.1 m/s
  NearTipField cracked = around(L);
  open_crack(cracked, 1.5 * d);
  EXPECT_EQ(vortices(cracked, slow).size(), 0u);
  L << 1e4, 0., 0., 2e4; // node
  EXPECT_EQ(vortices(around(L), slow).size(), 0u);
  L << 1e4, -2e3, 2e3, 2e4; // node with circulation: 9e8 = trace^2 > 4 det = 8.2e8
  EXPECT_EQ(vortices(around(L), slow).size(), 0u);
  L << 1e4, 0., 0., -1e4; // saddle
  EXPECT_EQ(vortices(around(L), slow).size(), 0u);
  // A zero at a point of the grid gives exactly one vortex.
  L << 0., -1e4, 1e4, 0.;
  EXPECT_EQ(vortices(field_of([&](const Eigen::Vector2d &X) -> Eigen::Vector2d { return L * X; }), slow).size(), 1u);
}

TEST(FollowingZone, IsWhatHangsTogetherNearTheTip)
{
  const auto velocity = [](const Eigen::Vector2d &X) -> Eigen::Vector2d
  {
    const bool zone = X.x() > -12.5 * d && X.x() < -1.5 * d && std::abs(X.y()) < 3. * d;
    const bool apart = X.x() > -25. * d && X.x() < -15. * d;
    return {zone ? 20. - X.x() / d : apart ? 40. : X.x() > 0.5 * d ? 90. : 5., 0.};
  };
  const FollowingZone zone = following_zone(field_of(velocity), 10.);
  EXPECT_NEAR(zone.length, 11 * d, 1e-9 * d); // points -2 to -12 d
  EXPECT_EQ(zone.fastest, 40.);               // over all points behind the tip
  EXPECT_NEAR(zone.place.x(), -24 * d, 1e-9 * d);
  EXPECT_NEAR(following_zone(field_of(velocity), 25.).length, 7 * d, 1e-9 * d); // points -6 to -12 d
  EXPECT_EQ(following_zone(field_of(velocity), 50.).length, 0.);
  NearTipField cracked = field_of(velocity);
  open_crack(cracked, 1.2 * d);
  EXPECT_NEAR(following_zone(cracked, 10.).length, 11 * d, 1e-9 * d); // along the flanks
}

// The box -14 d <= X <= -3 d, |Y| <= 3 d has twelve by seven points, with a crescent across it.
TEST(SpeedsBehindTip, AreThoseOfTheMaterialInTheBox)
{
  const auto crescent = [](const Eigen::Vector2d &X) -> Eigen::Vector2d
  {
    const bool inside = X.x() > -14.5 * d && X.x() < -2.5 * d && std::abs(X.y()) < 3.1 * d;
    const bool fast = X.x() > -7.5 * d && X.x() < -4.5 * d; // points -7, -6 and -5
    return {inside ? (fast ? 20. : 5.) : 99., 0.};
  };
  const std::vector<double> speeds = speeds_behind_tip(field_of(crescent));
  EXPECT_EQ(speeds.size(), 12u * 7u);
  EXPECT_EQ(std::count(speeds.begin(), speeds.end(), 20.), 3 * 7);
  EXPECT_EQ(std::count(speeds.begin(), speeds.end(), 5.), 9 * 7);
  // The opening has no material: three rows on each side remain, or none.
  NearTipField cracked = field_of(crescent);
  open_crack(cracked, 0.5 * d);
  EXPECT_EQ(speeds_behind_tip(cracked).size(), 12u * 6u);
  open_crack(cracked, 4. * d);
  EXPECT_TRUE(speeds_behind_tip(cracked).empty());
  // With the lattice rotated by 30 degrees the pitches are exchanged, and the same box has thirteen by seven points.
  const NearTipGrid turned{std::sqrt(0.75) * d, d, d, 30, 30, 30}, fine{0.5 * d, 0.5 * d, d, 60, 60, 60};
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  EXPECT_EQ(speeds_behind_tip(field_of(crescent, identity, turned)).size(), 13u * 7u); // X from -16 to -4 pitches
  EXPECT_EQ(speeds_behind_tip(field_of(crescent, identity, fine)).size(), 23u * 13u);
}

// The peak of sigma_yy = 1 + c sin^2(t) sin^2(3 t / 2) is that of the product, determined on a fine grid of angles.
TEST(OpeningStress, HasTheLobesOfAKidney)
{
  const auto lobes = [](double theta)
  { return 1e5 * (1. + 2. * std::pow(std::sin(theta), 2) * std::pow(std::sin(1.5 * theta), 2)); };
  double best = 0.;
  for (double theta = 0.; theta < 2.; theta += 1e-4)
    best = lobes(theta) > lobes(best) ? theta : best;
  const auto stressed = [](const auto &law)
  {
    NearTipField field = field_of([](const Eigen::Vector2d &) -> Eigen::Vector2d { return Eigen::Vector2d::Zero(); });
    for (int j = -30; j <= 30; ++j)
      for (int i = -30; i <= 30; ++i)
      {
        const Eigen::Vector2d X = field.grid.reference(i, j);
        field.cauchy_stress[field.grid.point(i, j)](1, 1) = law(std::atan2(X.y(), X.x()));
      }
    return field;
  };
  const auto found = opening_stress(stressed(lobes), 16 * d);
  ASSERT_TRUE(found);
  // One spacing is 3.6 degrees at 16 d: the interpolation error is its square times the curvature, 1 %, which shifts
  // such a flat maximum by a few degrees.
  EXPECT_NEAR(found->angle, best * 180. / M_PI, 3.);
  EXPECT_NEAR(found->peak, lobes(best), 0.01 * lobes(best));
  EXPECT_NEAR(found->ratio, lobes(best) / lobes(0.), 0.02 * lobes(best) / lobes(0.));
  // One lobe ahead, and a lobe on one side only.
  const auto ahead = opening_stress(stressed([](double theta) { return 1e5 * (2. + std::cos(theta)); }), 8 * d);
  EXPECT_EQ(ahead->angle, 0.);
  EXPECT_EQ(ahead->ratio, 1.);
  const auto one_side = opening_stress(
    stressed([](double theta) { return 1e5 * (1. + (theta > 0. ? std::pow(std::sin(theta), 2) : 0.)); }), 16 * d);
  EXPECT_NEAR(one_side->angle, 90., 2.);
  EXPECT_NEAR(one_side->ratio, 1.5, 0.01);
  NearTipField cracked = stressed(lobes);
  open_crack(cracked, 25 * d);
  EXPECT_FALSE(opening_stress(cracked, 16 * d));
  EXPECT_FALSE(opening_stress(stressed([](double) { return -1.; }), 8 * d));
}

// Flanks at +30 and -20 degrees to the axis of the crack: 50 degrees between them, regardless of debris ahead.
TEST(WedgeAngle, IsThatBetweenTheFlanks)
{
  const Eigen::Vector2d pitch(2.3 * d, 2.4 * d);
  std::vector<Eigen::Vector2d> sites;
  const double rise = std::tan(30. * M_PI / 180.), fall = std::tan(20. * M_PI / 180.);
  for (double x = -100 * d; x < 30 * d; x += pitch.x())
    for (double step = 0.; step < 40 * d; step += pitch.y())
    {
      const double open = std::max(0., -x);
      sites.push_back({x + 0.2 * d, open * rise + 0.5 * pitch.y() + step});
      sites.push_back({x + 0.2 * d, -open * fall - 0.5 * pitch.y() - step});
    }
  const auto angle = wedge_angle(sites, pitch, 5 * 2.3 * d, 25 * 2.3 * d);
  ASSERT_TRUE(angle);
  EXPECT_NEAR(*angle * 180. / M_PI, 50., 1e-9);
  // An intact sheet has no wedge.
  std::vector<Eigen::Vector2d> whole;
  for (double x = -100 * d; x < 30 * d; x += pitch.x())
    for (double y = -40 * d; y < 40 * d; y += pitch.y())
      whole.push_back({x, y});
  EXPECT_FALSE(wedge_angle(whole, pitch, 5 * 2.3 * d, 25 * 2.3 * d));
}

TEST(WedgeAngle, RefusesDistancesAndPitchesOutOfRange)
{
  const std::vector<Eigen::Vector2d> sites{{0., 0.}};
  const Eigen::Vector2d pitch(d, d);
  EXPECT_FALSE(wedge_angle(sites, pitch, d, d));
  EXPECT_THROW(wedge_angle(sites, pitch, 25. * d, 5. * d), std::invalid_argument);
  EXPECT_THROW(wedge_angle(sites, pitch, 5. * d, std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(wedge_angle(sites, {0., d}, 5. * d, 25. * d), std::invalid_argument);
  EXPECT_THROW(wedge_angle(sites, {-d, d}, 5. * d, 25. * d), std::invalid_argument);
}

} // namespace near_tip_measurement_test
