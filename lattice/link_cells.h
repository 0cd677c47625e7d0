#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
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
  LinkCells(const LinkCells &) = delete; // remembers where its points are
  LinkCells &operator=(const LinkCells &) = delete;

  /// Removes all points.
  void clear()
  {
    points_.clear();
    where_.clear();
  }

  /// Puts the point `id` at (x, y) [m], wherever it was before. A point whose position is not finite is near nothing.
  /// @param id small number, to which memory grows
  void put(std::size_t id, double x, double y)
  {
    if (id >= where_.size())
      where_.resize(id + 1, points_.end());
    const bool is_inside = inside(x, y);
    const Cell cell = is_inside ? Cell(number(x), number(y)) : Cell();
    if (where_[id] != points_.end())
    {
      if (is_inside && where_[id]->first == cell) // as for most that have moved
        return;
      points_.erase(where_[id]);
    }
    where_[id] = is_inside ? points_.emplace(cell, id) : points_.end();
  }

  /// Calls visit(id) once for every point that is at `reach` or less from (x, y), and for some that are farther: all in
  /// the cell of (x, y) and the eight around it. A point at (x, y) itself is among them.
  template <class Visitor>
  void for_each_near(double x, double y, Visitor &&visit) const
  {
    if (!inside(x, y))
      return;
    for (std::int64_t column = number(x) - 1; column <= number(x) + 1; ++column)
      for (auto point = points_.lower_bound({column, number(y) - 1});
           point != points_.end() && point->first <= Cell(column, number(y) + 1); ++point)
        visit(point->second);
  }

private:
  using Cell = std::pair<std::int64_t, std::int64_t>; // column, row

  /// Two points at exactly `reach` must be in cells that touch, whatever the rounding of their quotients.
  static constexpr double room = 1. + 1e-6;
  /// Beyond this many cells from the origin rounding would eat the room, and nothing of a sheet is there.
  static constexpr double farthest_cell = 1e9;

  bool inside(double x, double y) const
  {
    return std::abs(x * inverse_size_) < farthest_cell && std::abs(y * inverse_size_) < farthest_cell;
  }
  std::int64_t number(double coordinate) const
  {
    return static_cast<std::int64_t>(std::floor(coordinate * inverse_size_));
  }

  double inverse_size_;
  std::multimap<Cell, std::size_t> points_;
  std::vector<std::multimap<Cell, std::size_t>::iterator> where_; // of each id; the end: nowhere
};

} // namespace latcon::lattice
