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

void LinkCells::clear(std::size_t n)
{
  std::size_t buckets = 1;
  while (buckets < 2 * n)
    buckets *= 2;
  points_.clear();
  first_.assign(buckets, none);
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

void LinkCells::insert(std::size_t id, double x, double y)
{
  if (!inside(x, y))
    return;
  const std::int64_t column = cell(x), row = cell(y);
  std::size_t &head = first_[bucket(column, row)];
  points_.push_back({id, column, row, head});
  head = points_.size() - 1;
}

} // namespace latcon::lattice
