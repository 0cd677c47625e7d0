#include "lattice/cutout.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

// Lengths are compared with some room, so that whole spacings mean the same on every machine.
constexpr double relative_room = 1e-9;

// Lists of more sites would take more memory than a check may.
constexpr double most_sites = 1e7;

// All sites in the box, by increasing X, then Y.
std::vector<std::size_t> sites_in(const Eigen::AlignedBox2d &box, const TriangularLattice &lattice)
{
  const auto [rows, columns] = lattice.window(box.min(), box.max());
  support::require(double(rows.end - rows.begin) * double(columns.end - columns.begin) <= most_sites,
                   "it takes more than 1e7 sites");
  std::vector<std::size_t> sites;
  for (const std::size_t place : lattice.sites(rows, columns))
    if (box.contains(lattice.reference(place)))
      sites.push_back(place);
  // Sites at one X are stored by increasing Y.
  const double room = relative_room * lattice.spacing();
  std::stable_sort(sites.begin(), sites.end(),
                   [&](std::size_t a, std::size_t b)
                   { return lattice.reference(a).x() < lattice.reference(b).x() - room; });
  return sites;
}

// Returns the sites of a seed crack if it can be one.
std::vector<std::size_t> checked(std::vector<std::size_t> sites, const TriangularLattice &lattice)
{
  support::require(!sites.empty(), "there is no site in it");
  const double highest = 0.5 * lattice.height() - 2. * lattice.spacing();
  for (const std::size_t place : sites)
    support::require(std::abs(lattice.reference(place).y()) <= highest,
                     "it comes within two spacings of the lower or the upper edge of the sheet");
  return sites;
}

} // namespace

void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout)
{
  const double room = relative_room * lattice.spacing(), radius = cutout.hole_radius, notch = cutout.notch_length;
  const Eigen::Vector2d middle(0.5 * lattice.length(), 0.);
  const auto is_cut = [&](const Eigen::Vector2d &X)
  { return (X - middle).norm() < radius - room || (notch > 0. && std::abs(X.y()) <= room && X.x() <= notch + room); };
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_site(place) && is_cut(lattice.reference(place)))
    {
      state.removed[place] = 1;
      state.held[place] = state.rollers[place] = 0;
      state.inverse_mass[place] = 0.;
      for_each_bond_of_site(state, lattice, place, [&](const Bond &bond) { state.bonds.remove(bond.near, bond.kind); });
    }
  if (notch > 0.) // through the slit between sites
    for (const auto &[place, kind] : bonds_across(lattice, -lattice.spacing(), notch + room, 0.))
      state.bonds.remove(place, kind);
}

std::vector<std::pair<std::size_t, std::size_t>> bonds_across(const TriangularLattice &lattice, double from, double to,
                                                              double Y)
{
  std::vector<std::pair<std::size_t, std::size_t>> bonds;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    for (std::size_t kind = 0; kind < lattice.n_kinds() && lattice.is_site(place); ++kind)
      if (const Bond bond = lattice.bond(place, kind); lattice.has_bond(place, kind) && lattice.is_site(bond.far))
      {
        const Eigen::Vector2d X = lattice.reference(place), R = lattice.bond_vector(bond);
        const double share = (Y - X.y()) / R.y(), at = X.x() + share * R.x();
        if (share > 0. && share <= 1. && at >= from && at <= to)
          bonds.emplace_back(place, kind);
      }
  return bonds;
}

std::vector<std::size_t> seed_line(const TriangularLattice &lattice, const Eigen::Vector2d &start, std::size_t n)
{
  const double h = lattice.spacing(), room = relative_room * h, top = 0.5 * lattice.height();
  // Lines are at most a spacing apart, and their sites less than two.
  const Eigen::Vector2d inside(std::clamp(start.x(), 0., lattice.length()), std::clamp(start.y(), -top, top));
  const Eigen::Vector2d around(2. * h, 0.5 * h + room), end(2. * h * static_cast<double>(n), 0.);
  std::vector<std::size_t> sites = sites_in({inside - around, inside + end + around}, lattice);
  const auto nearest = [&](int axis)
  {
    const auto distance = [&](std::size_t place) // less than that of one as near with a smaller coordinate
    { return std::abs(lattice.reference(place)[axis] - start[axis] - room); };
    return std::min_element(sites.begin(), sites.end(),
                            [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  };
  const double Y = lattice.reference(*nearest(1)).y();
  const auto is_off = [&](std::size_t place) { return std::abs(lattice.reference(place).y() - Y) > room; };
  sites.erase(std::remove_if(sites.begin(), sites.end(), is_off), sites.end());
  const auto first = nearest(0);
  support::require(sites.end() - first >= static_cast<std::ptrdiff_t>(n), "it goes beyond the right end of the sheet");
  return checked({first, first + static_cast<std::ptrdiff_t>(n)}, lattice);
}

std::vector<std::size_t> seed_slit(const TriangularLattice &lattice, const Eigen::Vector2d &lower,
                                   const Eigen::Vector2d &upper)
{
  const Eigen::Vector2d room = Eigen::Vector2d::Constant(relative_room * lattice.spacing());
  return checked(sites_in({lower - room, upper + room}, lattice), lattice);
}

} // namespace latcon::lattice
