#include "lattice/seed.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lattice
{
namespace
{

// Lengths are compared with some room, so that whole spacings mean the same on every machine.
constexpr double round_off = 1e-9;

struct Site
{
  std::size_t place;
  Eigen::Vector2d X;
};

// All sites that are `chosen`, by increasing X, then Y.
template <class Predicate>
std::vector<Site> sites_where(const TriangularLattice &lattice, const Predicate &chosen)
{
  std::vector<Site> sites;
  for (std::size_t row = 0; row < lattice.rows(); ++row)
    for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice.index(row, column);
      const Eigen::Vector2d X = lattice.reference(place);
      if (chosen(X))
        sites.push_back({place, X});
    }
  const double room = round_off * lattice.spacing();
  std::sort(sites.begin(), sites.end(),
            [room](const Site &a, const Site &b)
            { return std::abs(a.X.x() - b.X.x()) > room ? a.X.x() < b.X.x() : a.X.y() < b.X.y(); });
  return sites;
}

std::vector<Site> sites_of(const SeedSlit &slit, const TriangularLattice &lattice)
{
  const double room = round_off * lattice.spacing();
  return sites_where(lattice,
                     [&](const Eigen::Vector2d &X)
                     {
                       return X.x() >= slit.position - room && X.x() <= slit.position + slit.length + room &&
                              std::abs(X.y() - slit.offset) <= 0.5 * slit.height + room;
                     });
}

std::vector<Site> sites_of(const SeedLine &line, const TriangularLattice &lattice)
{
  const double room = round_off * lattice.spacing();
  // Later ones win among equals, since all go by increasing coordinate.
  double nearest_y = 0., smallest = -1.;
  for (const Site &site : sites_where(lattice, [](const Eigen::Vector2d &) { return true; }))
  {
    const double distance = std::abs(site.X.y() - line.offset);
    if (smallest < 0. || distance < smallest - room || (distance <= smallest + room && site.X.y() > nearest_y + room))
    {
      smallest = distance;
      nearest_y = site.X.y();
    }
  }
  const std::vector<Site> candidates =
    sites_where(lattice, [&](const Eigen::Vector2d &X) { return std::abs(X.y() - nearest_y) <= room; });
  std::size_t first = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (std::abs(candidates[i].X.x() - line.position) <= std::abs(candidates[first].X.x() - line.position) + room)
      first = i;
  if (first + line.n > candidates.size())
    throw std::invalid_argument("it goes beyond the right end of the sheet");
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(line.n)};
}

} // namespace

std::vector<std::size_t> seed_sites(const TriangularLattice &lattice, const Seed &seed)
{
  const std::vector<Site> sites = std::visit([&](const auto &shape) { return sites_of(shape, lattice); }, seed);
  if (sites.empty())
    throw std::invalid_argument("there is no site in it");
  const double highest = 0.5 * lattice.height() - 2. * lattice.spacing();
  std::vector<std::size_t> places;
  for (const Site &site : sites)
  {
    if (std::abs(site.X.y()) > highest)
      throw std::invalid_argument("it comes within two spacings of the lower or the upper edge of the sheet");
    places.push_back(site.place);
  }
  return places;
}

} // namespace lattice
