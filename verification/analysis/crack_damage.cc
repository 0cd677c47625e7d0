#include "verification/analysis/crack_measurement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <Eigen/Core>

namespace latcon::analysis
{
namespace
{

/// Returns the widest gap between neighbouring strands of one column [m]; 0 if there are fewer than two strands.
double widest_gap(std::vector<double> &Y, double gap, double min_bonds)
{
  std::sort(Y.begin(), Y.end());
  double widest = 0.;
  bool has_previous = false;
  double previous_top = 0.;
  for (std::size_t begin = 0, end; begin < Y.size(); begin = end)
  {
    end = begin + 1;
    while (end < Y.size() && Y[end] - Y[end - 1] < gap)
      ++end;
    if (static_cast<double>(end - begin) < min_bonds)
      continue;
    if (has_previous)
      widest = std::max(widest, Y[begin] - previous_top);
    has_previous = true;
    previous_top = Y[end - 1];
  }
  return widest;
}

// Returns the fraction of columns that branched_fraction() counts. It does not depend on the width of the columns, if
// this resolves the strands. @param gaps of each column, along X: the widest between neighbouring strands [m]; 0: fewer
// than two strands
double share_of_branches(const std::vector<double> &gaps, double column_width, double spacing, const BranchRule &rule)
{
  // A run of columns as long as the persistence may be shorter by rounding.
  const double persistence = rule.persistence * spacing * (1. - 1e-12);
  std::size_t n_branched = 0;
  for (std::size_t begin = 0, end; begin < gaps.size(); begin = end)
  {
    end = begin + 1;
    if (gaps[begin] == 0.)
      continue;
    while (end < gaps.size() && gaps[end] > 0.)
      ++end;
    const double widest = *std::max_element(gaps.begin() + static_cast<std::ptrdiff_t>(begin),
                                            gaps.begin() + static_cast<std::ptrdiff_t>(end));
    if (static_cast<double>(end - begin) * column_width >= persistence && widest >= rule.grown_gap * spacing)
      n_branched += end - begin;
  }
  return gaps.empty() ? 0. : static_cast<double>(n_branched) / static_cast<double>(gaps.size());
}

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

double branched_fraction(const std::vector<BreakRecord> &breaks, double X_begin, double X_end, double lattice_spacing,
                         const BranchRule &rule)
{
  const double width = rule.column_width * lattice_spacing;
  if (!(X_end - X_begin >= width))
    return 0.;
  if (!(X_end - X_begin < 1e9 * width))
    throw std::invalid_argument("branched_fraction: the interval must contain fewer than 1e9 columns");
  const auto n_columns = static_cast<std::size_t>((X_end - X_begin) / width);
  std::vector<std::vector<double>> columns(n_columns);
  for (const BreakRecord &bond : breaks)
  {
    const double column = std::floor((bond.X - X_begin) / width);
    if (column >= 0. && column < static_cast<double>(n_columns))
      columns[static_cast<std::size_t>(column)].push_back(bond.Y);
  }

  std::vector<double> gaps;
  gaps.reserve(n_columns);
  for (std::vector<double> &column : columns)
    gaps.push_back(widest_gap(column, rule.gap * lattice_spacing, rule.bonds_per_spacing * rule.column_width));
  return share_of_branches(gaps, width, lattice_spacing, rule);
}

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
