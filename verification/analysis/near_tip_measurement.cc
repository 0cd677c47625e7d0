#include "verification/analysis/near_tip_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "support/fits.h"

namespace latcon::analysis
{
namespace
{

constexpr int points_on_circle = 72;
constexpr double vortex_radius = 2.; // [d]

Eigen::Vector2d on_circle(const Eigen::Vector2d &centre, double radius, double angle)
{
  return centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

// Interpolates `value(i, j)` bilinearly at a reference position relative to the tip; none unless all four points around
// it have material.
template <typename Value>
auto interpolate(const NearTipField &field, const Eigen::Vector2d &X, const Value &value)
  -> std::optional<std::decay_t<decltype(value(0, 0))>>
{
  const double u = X.x() / field.grid.pitch_X, v = X.y() / field.grid.pitch_Y;
  if (!(u >= -field.grid.behind && u <= field.grid.ahead && std::abs(v) <= field.grid.half_height))
    return std::nullopt;
  // On the last line of points, use the cell before it.
  const int i = std::min(static_cast<int>(std::floor(u)), field.grid.ahead - 1);
  const int j = std::min(static_cast<int>(std::floor(v)), field.grid.half_height - 1);
  if (!field.holds(i, j) || !field.holds(i + 1, j) || !field.holds(i, j + 1) || !field.holds(i + 1, j + 1))
    return std::nullopt;
  const double s = u - i, t = v - j;
  return (1. - t) * ((1. - s) * value(i, j) + s * value(i + 1, j)) +
         t * ((1. - s) * value(i, j + 1) + s * value(i + 1, j + 1));
}

double fastest(const NearTipField &field)
{
  double square = 0.;
  for (std::size_t point = 0; point < field.grid.size(); ++point)
    if (field.occupancy[point] >= 0.5)
      square = std::max(square, field.velocity[point].squaredNorm());
  return std::sqrt(square);
}

// Returns the winding number of a vector around the corners of a cell: the Poincare index of its interior.
int winding(const std::array<Eigen::Vector2d, 4> &corners)
{
  double turned = 0.;
  for (std::size_t c = 0; c < 4; ++c)
  {
    const Eigen::Vector2d &a = corners[c], &b = corners[(c + 1) % 4];
    turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return static_cast<int>(std::lround(turned / (2. * M_PI)));
}

// Returns the means over a cell of the derivatives along the grid, as columns, per pitch, from corner values
// (counter-clockwise from the lower left).
Eigen::Matrix2d cell_derivatives(const std::array<Eigen::Vector2d, 4> &corners)
{
  Eigen::Matrix2d derivatives;
  derivatives << 0.5 * (corners[1] - corners[0] + corners[2] - corners[3]),
    0.5 * (corners[3] - corners[0] + corners[2] - corners[1]);
  return derivatives;
}

} // namespace

NegativeZone negative_zone(const std::vector<PointVelocity> &points, const Eigen::Vector2d &pitch, double limit)
{
  NegativeZone zone{0., 0., std::nullopt, 0., Eigen::Vector2d::Zero()};
  double last = 0.;
  std::size_t n = 0;
  for (const auto &[X, v] : points)
  {
    if (!std::isfinite(v))
      return {v, v, std::nullopt, v, X};
    if (X.x() <= 0.)
      continue;
    if (v < zone.depth)
    {
      zone.depth = v;
      zone.deepest = X;
    }
    if (!(v < -limit))
      continue;
    ++n;
    zone.distance = std::min(zone.distance.value_or(X.x()), X.x());
    last = std::max(last, X.x());
  }
  if (n == 0)
    return zone;
  zone.area = static_cast<double>(n) * pitch.x() * pitch.y();
  zone.length = (std::round((last - *zone.distance) / pitch.x()) + 1.) * pitch.x();
  return zone;
}

NegativeZone negative_zone(const NearTipField &field, double laboratory_speed, double fraction)
{
  const NearTipGrid &grid = field.grid;
  std::vector<PointVelocity> points;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = 1; i <= grid.ahead; ++i)
      if (field.holds(i, j))
        points.push_back({grid.reference(i, j), field.velocity[grid.point(i, j)].x()});
  return negative_zone(points, {grid.pitch_X, grid.pitch_Y}, fraction * laboratory_speed);
}

std::optional<double> velocity_asymmetry(const NearTipField &field)
{
  const NearTipGrid &grid = field.grid;
  double difference = 0., whole = 0.;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= grid.ahead; ++i)
      if (field.holds(i, j) && field.holds(i, -j))
      {
        const Eigen::Vector2d v = field.velocity[grid.point(i, j)];
        const Eigen::Vector2d image = field.velocity[grid.point(i, -j)];
        difference += (v - Eigen::Vector2d(image.x(), -image.y())).squaredNorm();
        whole += v.squaredNorm();
      }
  if (!(whole > 0.))
    return std::nullopt;
  return std::sqrt(difference / whole);
}

std::optional<double> circulation(const NearTipField &field, const Eigen::Vector2d &centre, double radius,
                                  bool across_opening)
{
  struct Point
  {
    Eigen::Vector2d x, v;
  };
  std::vector<std::optional<Point>> circle;
  for (int n = 0; n < points_on_circle; ++n)
  {
    const Eigen::Vector2d X = on_circle(centre, radius, 2. * M_PI * n / points_on_circle);
    const auto x = interpolate(field, X, [&](int i, int j) { return field.position(i, j); });
    const auto v = interpolate(field, X, [&](int i, int j) { return field.velocity[field.grid.point(i, j)]; });
    if (x)
      circle.push_back(Point{*x, *v});
    else if (across_opening)
      circle.push_back(std::nullopt);
    else
      return std::nullopt;
  }
  double sum = 0.;
  bool any = false;
  for (std::size_t n = 0; n < circle.size(); ++n)
  {
    const std::optional<Point> &a = circle[n], &b = circle[(n + 1) % circle.size()];
    if (!a || !b)
      continue;
    sum += 0.5 * (a->v + b->v).dot(b->x - a->x);
    any = true;
  }
  if (!any)
    return std::nullopt;
  return sum;
}

std::vector<Vortex> vortices(const NearTipField &field, double slowest, double within)
{
  const NearTipGrid &grid = field.grid;
  const double radius = vortex_radius * grid.spacing;
  const Eigen::Vector2d pitch(grid.pitch_X, grid.pitch_Y);
  // This offset assigns a zero in a corner to one of the cells around it.
  const Eigen::Vector2d nudge = 1e-12 * fastest(field) * Eigen::Vector2d(1., std::sqrt(2.));
  std::vector<Vortex> found;
  for (int j = -grid.half_height; j < grid.half_height; ++j)
    for (int i = -grid.behind; i < grid.ahead; ++i)
    {
      if (grid.reference(i, j).squaredNorm() > within * within || !field.holds(i, j) || !field.holds(i + 1, j) ||
          !field.holds(i + 1, j + 1) || !field.holds(i, j + 1))
        continue;
      std::array<Eigen::Vector2d, 4> v, x;
      const std::array<std::array<int, 2>, 4> corners{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      for (std::size_t c = 0; c < 4; ++c)
      {
        v[c] = field.velocity[grid.point(corners[c][0], corners[c][1])] + nudge;
        x[c] = field.position(corners[c][0], corners[c][1]);
      }
      if (winding(v) != 1)
        continue;
      const Eigen::Matrix2d dv = cell_derivatives(v), dx = cell_derivatives(x);
      const Eigen::Matrix2d L = dv * dx.inverse(); // dv/dx: the pitches cancel
      if (!(L.trace() * L.trace() < 4. * L.determinant()))
        continue;
      // Zero of the linear part, relative to the centre of the cell, in pitches.
      const Eigen::Vector2d middle = 0.25 * (v[0] + v[1] + v[2] + v[3]);
      const Eigen::Vector2d offset = (-dv.inverse() * middle).cwiseMax(-0.5).cwiseMin(0.5);
      const Eigen::Vector2d place = grid.reference(i, j) + pitch.cwiseProduct(Eigen::Vector2d(0.5, 0.5) + offset);
      const std::optional<double> turning = circulation(field, place, radius, false);
      if (!turning)
        continue;
      // Approximate length of the circle in the current configuration, accurate enough for a threshold.
      const double length = 2. * M_PI * radius * std::sqrt(std::abs(dx.determinant()) / pitch.prod());
      const double speed = std::abs(*turning) / length;
      if (speed > slowest)
        found.push_back({place, *turning, speed});
    }
  std::sort(found.begin(), found.end(),
            [](const Vortex &a, const Vortex &b) { return a.position.norm() < b.position.norm(); });
  return found;
}

FollowingZone following_zone(const NearTipField &field, double speed)
{
  const NearTipGrid &grid = field.grid;
  FollowingZone zone{0., -std::numeric_limits<double>::infinity(), Eigen::Vector2d::Zero()};
  std::vector<std::array<int, 2>> front;
  std::vector<bool> seen(grid.size(), false);
  const auto visit = [&](int i, int j)
  {
    if (i > 0 || !field.holds(i, j) || seen[grid.point(i, j)] || !(field.velocity[grid.point(i, j)].x() > speed))
      return;
    seen[grid.point(i, j)] = true;
    front.push_back({i, j});
  };
  constexpr int reach = 8;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= 0; ++i)
    {
      if (field.holds(i, j) && field.velocity[grid.point(i, j)].x() > zone.fastest)
      {
        zone.fastest = field.velocity[grid.point(i, j)].x();
        zone.place = grid.reference(i, j);
      }
      if (i * i + j * j <= reach * reach)
        visit(i, j);
    }
  int first = -grid.behind - 1, last = 0;
  while (!front.empty())
  {
    const auto [i, j] = front.back();
    front.pop_back();
    first = std::max(first, i);
    last = std::min(last, i);
    for (const auto &[di, dj] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}})
      visit(i + di, j + dj);
  }
  if (first >= last)
    zone.length = (first - last + 1) * grid.pitch_X;
  return zone;
}

std::vector<double> speeds_behind_tip(const NearTipField &field)
{
  constexpr double from = 3., to = 14., half_height = 3., rounding = 1e-9; // [d]
  const NearTipGrid &grid = field.grid;
  std::vector<double> speeds;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= 0; ++i)
    {
      const Eigen::Vector2d X = grid.reference(i, j) / grid.spacing;
      if (X.x() > -to - rounding && X.x() < -from + rounding && std::abs(X.y()) < half_height + rounding &&
          field.holds(i, j))
        speeds.push_back(field.velocity[grid.point(i, j)].x());
    }
  return speeds;
}

std::vector<double> backward_speeds(const NearTipField &field)
{
  const NearTipGrid &grid = field.grid;
  std::vector<double> speeds;
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = 1; i <= grid.ahead; ++i)
      if (field.holds(i, j) && field.velocity[grid.point(i, j)].x() < 0.)
        speeds.push_back(field.velocity[grid.point(i, j)].x());
  return speeds;
}

std::optional<OpeningStress> opening_stress(const std::function<std::optional<double>(double)> &stress)
{
  constexpr int largest_angle = 120; // [degrees]
  double ahead = 0.;
  OpeningStress result{0., 1., -std::numeric_limits<double>::infinity()};
  for (int angle = 0; angle <= largest_angle; ++angle)
  {
    const std::optional<double> value = stress(angle * M_PI / 180.);
    if (!value)
      return std::nullopt;
    if (angle == 0)
      ahead = *value;
    if (*value > result.peak)
    {
      result.peak = *value;
      result.angle = angle;
    }
  }
  if (!(ahead > 0.))
    return std::nullopt;
  result.ratio = result.peak / ahead;
  return result;
}

std::optional<OpeningStress> opening_stress(const NearTipField &field, double radius)
{
  const auto stress = [&](double angle)
  {
    return interpolate(field, on_circle(Eigen::Vector2d::Zero(), radius, angle),
                       [&](int i, int j) { return field.cauchy_stress[field.grid.point(i, j)](1, 1); });
  };
  return opening_stress(
    [&](double angle) -> std::optional<double>
    {
      const std::optional<double> above = stress(angle), below = stress(-angle);
      if (!above || !below)
        return std::nullopt;
      return 0.5 * (*above + *below);
    });
}

std::optional<double> wedge_angle(const std::vector<Eigen::Vector2d> &sites, const Eigen::Vector2d &pitch, double from,
                                  double to)
{
  const double strips_between = (to - from) / pitch.x();
  if (!(pitch.x() > 0. && pitch.y() > 0. && strips_between >= 0. && strips_between < 1e9))
    throw std::invalid_argument("wedge_angle: needs a positive pitch and from <= to");
  const auto n_strips = static_cast<std::size_t>(strips_between);
  std::vector<std::vector<Eigen::Vector2d>> strips(n_strips);
  for (const Eigen::Vector2d &site : sites)
  {
    const double strip = (-from - site.x()) / pitch.x();
    if (strip >= 0. && strip < static_cast<double>(n_strips))
      strips[static_cast<std::size_t>(strip)].push_back(site);
  }
  std::array<std::vector<double>, 2> x, y; // of the lower and the upper surface
  for (std::vector<Eigen::Vector2d> &strip : strips)
  {
    std::sort(strip.begin(), strip.end(),
              [](const Eigen::Vector2d &a, const Eigen::Vector2d &b)
              { return a.y() < b.y() || (a.y() == b.y() && a.x() < b.x()); });
    std::size_t opening = 0;
    double widest = 2. * pitch.y();
    for (std::size_t i = 1; i < strip.size(); ++i)
      if (strip[i].y() - strip[i - 1].y() > widest)
      {
        widest = strip[i].y() - strip[i - 1].y();
        opening = i;
      }
    if (opening == 0)
      continue;
    for (const std::size_t side : {0, 1})
    {
      x[side].push_back(strip[opening - 1 + side].x());
      y[side].push_back(strip[opening - 1 + side].y());
    }
  }
  if (x[0].size() < 2 || 2 * x[0].size() < n_strips)
    return std::nullopt;
  return std::atan(support::slope(x[0], y[0])) - std::atan(support::slope(x[1], y[1]));
}

} // namespace latcon::analysis
