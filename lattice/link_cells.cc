#include "lattice/link_cells.h"

#include <cmath>
#include <stdexcept>

namespace latcon::lattice
{
namespace
{

// Two points at exactly `reach` must be in cells that touch, whatever the rounding of their quotients.
constexpr double room = 1. + 1e-6;

// Beyond this many cells from the origin rounding would eat the room, and nothing of a sheet is there.
constexpr double farthest_cell = 1e9;

} // namespace

LinkCells::LinkCells(double reach) : inverse_size_(1. / (room * reach)), first_(1, none)
{
  if (!(reach > 0.))
    throw std::invalid_argument("link cells need a positive reach");
}

void LinkCells::clear()
{
  points_.clear();
  first_.assign(1, none);
}

bool LinkCells::inside(double x, double y) const
{
  return std::abs(x * inverse_size_) < farthest_cell && std::abs(y * inverse_size_) < farthest_cell;
}

std::int64_t LinkCells::cell(double coordinate) const
{
  return static_cast<std::int64_t>(std::floor(coordinate * inverse_size_));
}

std::size_t LinkCells::bucket(std::int64_t column, std::int64_t row) const
{
  // Multiplicative hashing (Teschner et al. 2003) with the upper bits brought down.
  const std::uint64_t mixed = static_cast<std::uint64_t>(column) * 0x9e3779b97f4a7c15ull ^
                              static_cast<std::uint64_t>(row) * 0xc2b2ae3d27d4eb4full;
  return static_cast<std::size_t>(mixed ^ (mixed >> 32)) & (first_.size() - 1);
}

void LinkCells::link(std::size_t id)
{
  std::size_t &first = first_[bucket(points_[id].column, points_[id].row)];
  points_[id].next = first;
  first = id;
}

void LinkCells::unlink(std::size_t id)
{
  std::size_t *next = &first_[bucket(points_[id].column, points_[id].row)];
  while (*next != id)
    next = &points_[*next].next;
  *next = points_[id].next;
}

void LinkCells::put(std::size_t id, double x, double y)
{
  if (id >= points_.size())
    points_.resize(id + 1, {0, 0, none, false});
  Point &point = points_[id];
  if (point.is_in_cell)
    unlink(id);
  point.is_in_cell = inside(x, y);
  if (!point.is_in_cell)
    return;
  point.column = cell(x);
  point.row = cell(y);
  link(id);
  if (points_.size() <= first_.size())
    return;
  first_.assign(4 * first_.size(), none);
  for (std::size_t other = 0; other < points_.size(); ++other)
    if (points_[other].is_in_cell)
      link(other);
}

} // namespace latcon::lattice
