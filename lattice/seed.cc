#include "lattice/seed.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "lattice/row_partition.h"

namespace latcon::lattice
{
namespace
{

// Lengths are compared with some room, so that whole spacings mean the same on every machine.
constexpr double relative_room = 1e-9;

// Lists of more sites would take more memory than a check may.
constexpr double most_sites = 1e7;

// The rows, or the columns, that have sites between two distances from the first; one more at either end, since odd
// rows are shifted.
Rows numbers_between(double from, double to, double pitch, std::size_t n)
{
  const auto clamped = [n](double number) { return static_cast<std::size_t>(std::clamp(number, 0., double(n))); };
  return {clamped(std::floor(from / pitch) - 1.), clamped(std::floor(to / pitch) + 2.)};
}

// All sites in the box, by increasing X, then Y.
std::vector<std::size_t> sites_in(const Eigen::AlignedBox2d &box, const TriangularLattice &lattice)
{
  const bool along_x = lattice.orientation() == Orientation::rows_along_crack;
  const Eigen::Vector2d first = lattice.reference(lattice.index(0, 0));
  const Eigen::Vector2d from = box.min() - first, to = box.max() - first;
  const double pitch = lattice.site_area() / lattice.spacing();
  const auto [along, across] = along_x ? std::pair(0, 1) : std::pair(1, 0);
  const Rows rows = numbers_between(from[across], to[across], pitch, lattice.rows());
  const Rows columns = numbers_between(from[along], to[along], lattice.spacing(), lattice.columns());
  if (double(rows.end - rows.begin) * double(columns.end - columns.begin) > most_sites)
    throw std::invalid_argument("it takes more than 1e7 sites");

  std::vector<std::size_t> sites;
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    for (std::size_t column = columns.begin; column < std::min(columns.end, lattice.sites_in_row(row)); ++column)
      if (box.contains(lattice.reference(lattice.index(row, column))))
        sites.push_back(lattice.index(row, column));
  const double room = relative_room * lattice.spacing();
  std::sort(sites.begin(), sites.end(),
            [&](std::size_t a, std::size_t b)
            {
              const Eigen::Vector2d A = lattice.reference(a), B = lattice.reference(b);
              return std::abs(A.x() - B.x()) > room ? A.x() < B.x() : A.y() < B.y();
            });
  return sites;
}

// Y of all lines along x on which sites stand.
std::vector<double> lines_of_sites(const TriangularLattice &lattice)
{
  std::vector<double> lines;
  if (lattice.orientation() == Orientation::rows_along_crack)
    for (std::size_t row = 0; row < lattice.rows(); ++row)
      lines.push_back(lattice.reference(lattice.index(row, 0)).y());
  else
    for (const std::size_t row : {0, 1})
      for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
        lines.push_back(lattice.reference(lattice.index(row, column)).y());
  return lines;
}

std::vector<std::size_t> sites_of(const SeedSlit &slit, const TriangularLattice &lattice)
{
  const double room = relative_room * lattice.spacing();
  const Eigen::Vector2d lower(slit.position - room, slit.offset - 0.5 * slit.height - room),
    upper(slit.position + slit.length + room, slit.offset + 0.5 * slit.height + room);
  return sites_in({lower, upper}, lattice);
}

std::vector<std::size_t> sites_of(const SeedLine &line, const TriangularLattice &lattice)
{
  const double room = relative_room * lattice.spacing();
  // Of two equally near ones the larger is taken.
  double nearest_y = 0., smallest = -1.;
  for (const double y : lines_of_sites(lattice))
  {
    const double distance = std::abs(y - line.offset);
    if (smallest < 0. || distance < smallest - room || (distance <= smallest + room && y > nearest_y + room))
    {
      smallest = distance;
      nearest_y = y;
    }
  }
  const Eigen::Vector2d lower(-lattice.spacing(), nearest_y - room),
    upper(lattice.length() + lattice.spacing(), nearest_y + room);
  const std::vector<std::size_t> candidates = sites_in({lower, upper}, lattice);
  const auto distance = [&](std::size_t i) { return std::abs(lattice.reference(candidates[i]).x() - line.position); };
  std::size_t first = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (distance(i) <= distance(first) + room)
      first = i;
  if (first + line.n > candidates.size())
    throw std::invalid_argument("it goes beyond the right end of the sheet");
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(line.n)};
}

} // namespace

std::vector<std::pair<std::size_t, std::size_t>> bonds_across(const TriangularLattice &lattice, double from, double to,
                                                              double Y)
{
  std::vector<std::pair<std::size_t, std::size_t>> bonds;
  for (std::size_t row = 0; row < lattice.rows(); ++row)
    for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
      for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
      {
        const Bond bond = lattice.bond(lattice.index(row, column), kind);
        if (!lattice.has_bond(bond.near, kind))
          continue;
        const Eigen::Vector2d X = lattice.reference(bond.near), R = lattice.bond_vector(bond);
        const double share = (Y - X.y()) / R.y(), at = X.x() + share * R.x();
        if (share > 0. && share <= 1. && at >= from && at <= to && lattice.is_site(bond.far))
          bonds.emplace_back(bond.near, kind);
      }
  return bonds;
}

std::vector<std::size_t> seed_sites(const TriangularLattice &lattice, const Seed &seed)
{
  std::vector<std::size_t> places = std::visit([&](const auto &shape) { return sites_of(shape, lattice); }, seed);
  if (places.empty())
    throw std::invalid_argument("there is no site in it");
  const double highest = 0.5 * lattice.height() - 2. * lattice.spacing();
  for (const std::size_t place : places)
    if (std::abs(lattice.reference(place).y()) > highest)
      throw std::invalid_argument("it comes within two spacings of the lower or the upper edge of the sheet");
  return places;
}

} // namespace latcon::lattice
