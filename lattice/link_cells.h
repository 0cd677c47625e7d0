#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "support/require.h"

namespace latcon::lattice
{

/// Points of the plane sorted into square cells, to find those near a position without looking at all of them (Allen
/// and Tildesley, Computer Simulation of Liquids, 2017, section 5.3.2). Only cells with points are kept, so that these
/// may spread as far as they like.
class LinkCells
{
public:
  /// A point as it was put last.
  struct Point
  {
    std::size_t id;           ///< given by the caller
    Eigen::Vector2d position; ///< [m]
  };

  /// @param reach distance up to which neighbours are wanted [m], > 0 @throws std::invalid_argument
  explicit LinkCells(double reach) : inverse_size_(1. / (room * reach))
  {
    support::require(reach > 0., "link cells need a positive reach");
  }

  void clear() { points_.clear(); } ///< removes all points

  /// Moves the point `id` between two positions [m]. A point whose position is not finite is near nothing, as one that
  /// was never put anywhere.
  void move(std::size_t id, const Eigen::Vector2d &from, const Eigen::Vector2d &to)
  {
    const Cell reached = cell(to);
    if (const auto left = points_.find(cell(from)); left != points_.end())
    {
      std::vector<Point> &others = left->second;
      others.erase(std::find_if(others.begin(), others.end(), [id](const Point &point) { return point.id == id; }));
      if (others.empty() && left->first != reached)
        points_.erase(left);
    }
    if (reached != nowhere)
      points_[reached].push_back({id, to});
  }

  /// Calls visit(point) once for every point that is at `reach` or less from a position, and for some that are farther:
  /// all in the cell of the position and the eight around it. A point at the position itself is among them.
  template <class Visitor>
  void for_each_near(const Eigen::Vector2d &position, Visitor &&visit) const
  {
    const Cell here = cell(position);
    for (const Cell column : {here - next_column, here, here + next_column})
      for (const Cell near : {column - 1, column, column + 1})
        if (const auto points = points_.find(near); points != points_.end())
          std::for_each(points->second.begin(), points->second.end(), visit);
  }

private:
  using Cell = std::int64_t; // column times next_column, plus row
  static constexpr Cell next_column = Cell{1} << 32;
  static constexpr Cell nowhere = Cell{1} << 62; // neither are those around it among the cells of points

  /// Two points at exactly `reach` must be in cells that touch, whatever the rounding of their quotients.
  static constexpr double room = 1. + 1e-6;
  /// Beyond this many cells from the origin rounding would eat the room, and nothing of a sheet is there.
  static constexpr double farthest_cell = 1e9;

  Cell cell(const Eigen::Vector2d &position) const
  {
    const double column = std::floor(position.x() * inverse_size_), row = std::floor(position.y() * inverse_size_);
    if (!(std::abs(column) < farthest_cell && std::abs(row) < farthest_cell))
      return nowhere;
    return static_cast<Cell>(column) * next_column + static_cast<Cell>(row);
  }

  double inverse_size_;
  std::unordered_map<Cell, std::vector<Point>> points_; // of each cell that has one
};

} // namespace latcon::lattice
