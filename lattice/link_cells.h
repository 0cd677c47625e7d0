#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace latcon::lattice
{

/// Points of the plane sorted into square cells, to find those near a position without looking at all of them (Allen
/// and Tildesley, Computer Simulation of Liquids, 2017, section 5.3.2). Only cells with points are kept, so that these
/// may spread as far as they like.
class LinkCells
{
public:
  /// @param reach distance up to which neighbours are wanted [m], > 0 @throws std::invalid_argument
  explicit LinkCells(double reach) : inverse_size_(1. / (room * reach))
  {
    if (!(reach > 0.))
      throw std::invalid_argument("link cells need a positive reach");
  }

  /// Removes all points.
  void clear()
  {
    points_.clear();
    cell_of_.clear();
  }

  /// Puts the point `id` at (x, y) [m], wherever it was before. A point whose position is not finite is near nothing.
  /// @param id small number, to which memory grows
  void put(std::size_t id, double x, double y)
  {
    if (id >= cell_of_.size())
      cell_of_.resize(id + 1, nowhere);
    const Cell from = std::exchange(cell_of_[id], cell(x, y)), to = cell_of_[id];
    if (from == to) // as for most that have moved
      return;
    if (from != nowhere)
    {
      const auto others = points_.find(from);
      others->second.erase(std::find(others->second.begin(), others->second.end(), id));
      if (others->second.empty())
        points_.erase(others);
    }
    if (to != nowhere)
      points_[to].push_back(id);
  }

  /// Calls visit(id) once for every point that is at `reach` or less from (x, y), and for some that are farther: all in
  /// the cell of (x, y) and the eight around it. A point at (x, y) itself is among them.
  template <class Visitor>
  void for_each_near(double x, double y, Visitor &&visit) const
  {
    const Cell here = cell(x, y);
    if (here == nowhere)
      return;
    for (const Cell column : {here - next_column, here, here + next_column})
      for (const Cell near : {column - 1, column, column + 1})
        if (const auto points = points_.find(near); points != points_.end())
          for (const std::size_t id : points->second)
            visit(id);
  }

private:
  using Cell = std::int64_t; // column times next_column, plus row
  static constexpr Cell next_column = Cell{1} << 32;
  static constexpr Cell nowhere = std::numeric_limits<Cell>::max();

  /// Two points at exactly `reach` must be in cells that touch, whatever the rounding of their quotients.
  static constexpr double room = 1. + 1e-6;
  /// Beyond this many cells from the origin rounding would eat the room, and nothing of a sheet is there.
  static constexpr double farthest_cell = 1e9;

  Cell cell(double x, double y) const
  {
    const double column = std::floor(x * inverse_size_), row = std::floor(y * inverse_size_);
    if (!(std::abs(column) < farthest_cell && std::abs(row) < farthest_cell))
      return nowhere;
    return static_cast<Cell>(column) * next_column + static_cast<Cell>(row);
  }

  double inverse_size_;
  std::unordered_map<Cell, std::vector<std::size_t>> points_; // of each cell that has one
  std::vector<Cell> cell_of_;                                 // by id
};

} // namespace latcon::lattice
