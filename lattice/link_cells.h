#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace latcon::lattice
{

/// Points of the plane sorted into square cells, to find those near a position without looking at all of them.
///
/// Cells are hashed, so the points may spread as far as they like (Allen and Tildesley, Computer Simulation of Liquids,
/// 2017, section 5.3.2, with a hash in place of the grid).
class LinkCells
{
public:
  /// @param reach distance up to which neighbours are wanted [m], > 0 @throws std::invalid_argument
  explicit LinkCells(double reach);

  /// Removes all points.
  void clear();

  /// Puts the point `id` at (x, y) [m], wherever it was before. A point whose position is not finite is near nothing.
  /// @param id small number, to which memory grows
  void put(std::size_t id, double x, double y);

  /// Calls visit(id) once for every point that is at `reach` or less from (x, y), and for some that are farther: all in
  /// the cell of (x, y) and the eight around it. A point at (x, y) itself is among them.
  template <class Visitor>
  void for_each_near(double x, double y, Visitor &&visit) const
  {
    if (!inside(x, y))
      return;
    const std::int64_t column = cell(x), row = cell(y);
    for (std::int64_t i = column - 1; i <= column + 1; ++i)
      for (std::int64_t j = row - 1; j <= row + 1; ++j)
        for (std::size_t id = first_[bucket(i, j)]; id != none; id = points_[id].next)
          if (points_[id].column == i && points_[id].row == j)
            visit(id);
  }

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Point
  {
    std::int64_t column, row;
    std::size_t next; // in the same bucket
    bool is_in_cell;
  };

  bool inside(double x, double y) const;
  std::int64_t cell(double coordinate) const;
  std::size_t bucket(std::int64_t column, std::int64_t row) const;
  void link(std::size_t id);
  void unlink(std::size_t id);

  double inverse_size_;
  std::vector<Point> points_;      // by id
  std::vector<std::size_t> first_; // point of each bucket; their number is a power of two
};

} // namespace latcon::lattice
