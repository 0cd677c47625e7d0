#include "verification/analysis/crack_flanks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace latcon::analysis
{
namespace
{

/// Distance from the path beyond which a broken bond counts as damage of the flanks [d]. Bonds of all shells that
/// cross the row of the tip, and bonds of sites that detach at a crest, are closer.
constexpr double flank_begins = 6.;

double distance_from_segment(const Eigen::Vector2d &P, const Eigen::Vector2d &A, const Eigen::Vector2d &B)
{
  const Eigen::Vector2d AB = B - A;
  const double square = AB.squaredNorm();
  const double part = square > 0. ? std::clamp((P - A).dot(AB) / square, 0., 1.) : 0.;
  return (P - A - part * AB).norm();
}

/// Returns the distance of P from the polyline through all positions of the tip.
double distance_from_path(const Eigen::Vector2d &P, const std::vector<TipRecord> &tip)
{
  const auto at = [&tip](std::size_t i) { return Eigen::Vector2d(tip[i].X, tip[i].Y); };
  const auto above =
    std::partition_point(tip.begin(), tip.end(), [&P](const TipRecord &entry) { return entry.X < P.x(); });
  const auto start = static_cast<std::size_t>(above - tip.begin());
  // Search outwards from X of the bond on either side, until the distance in X exceeds that of the nearest segment.
  double nearest = (P - at(std::min(start, tip.size() - 1))).norm();
  for (std::size_t i = start; i < tip.size() && tip[i > 0 ? i - 1 : 0].X - P.x() < nearest; ++i)
    nearest = std::min(nearest, distance_from_segment(P, at(i > 0 ? i - 1 : 0), at(i)));
  for (std::size_t i = start; i-- > 0 && P.x() - tip[i].X < nearest;)
    nearest = std::min(nearest, distance_from_segment(P, at(i > 0 ? i - 1 : 0), at(i)));
  return nearest;
}

} // namespace

std::optional<FlankDamage> flank_damage(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                                        double X_begin, double X_end, double spacing)
{
  if (tip.empty())
    return std::nullopt;
  FlankDamage damage{0., 0.};
  std::size_t bonds = 0, beside = 0;
  for (const BreakRecord &bond : breaks)
  {
    if (bond.X < X_begin || bond.X > X_end)
      continue;
    const double distance = distance_from_path({bond.X, bond.Y}, tip);
    damage.depth = std::max(damage.depth, distance);
    ++bonds;
    if (distance > flank_begins * spacing)
      ++beside;
  }
  if (bonds == 0)
    return std::nullopt;
  damage.share = static_cast<double>(beside) / static_cast<double>(bonds);
  return damage;
}

} // namespace latcon::analysis
