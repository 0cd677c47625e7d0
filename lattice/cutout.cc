#include "lattice/cutout.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "lattice/bonds/require.h"

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
  require(double(rows.end - rows.begin) * double(columns.end - columns.begin) <= most_sites,
          "it takes more than 1e7 sites");

  std::vector<std::size_t> sites;
  for (const std::size_t place : lattice.sites(rows, columns))
    if (box.contains(lattice.reference(place)))
      sites.push_back(place);
  const double room = relative_room * lattice.spacing();
  std::sort(sites.begin(), sites.end(),
            [&](std::size_t a, std::size_t b)
            {
              const Eigen::Vector2d A = lattice.reference(a), B = lattice.reference(b);
              return std::abs(A.x() - B.x()) > room ? A.x() < B.x() : A.y() < B.y();
            });
  return sites;
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
  const double h = lattice.spacing(), room = relative_room * h, top = 0.5 * lattice.height();
  // Lines are at most a spacing apart, and their sites less than two.
  const Eigen::Vector2d start(std::clamp(line.position, 0., lattice.length()), std::clamp(line.offset, -top, top));
  const Eigen::Vector2d around(2. * h, 0.5 * h + room), end(2. * h * static_cast<double>(line.n), 0.);
  std::vector<std::size_t> sites = sites_in({start - around, start + end + around}, lattice);
  const auto nearest = [&](int axis, double wanted)
  {
    return std::min_element(sites.begin(), sites.end(),
                            [&](std::size_t a, std::size_t b)
                            {
                              const double A = lattice.reference(a)[axis], B = lattice.reference(b)[axis];
                              const double farther = std::abs(A - wanted) - std::abs(B - wanted);
                              return std::abs(farther) > room ? farther < 0. : A > B;
                            });
  };
  const double Y = lattice.reference(*nearest(1, line.offset)).y();
  const auto is_off = [&](std::size_t place) { return std::abs(lattice.reference(place).y() - Y) > room; };
  sites.erase(std::remove_if(sites.begin(), sites.end(), is_off), sites.end());
  const auto first = nearest(0, line.position);
  require(sites.end() - first >= static_cast<std::ptrdiff_t>(line.n), "it goes beyond the right end of the sheet");
  return {first, first + static_cast<std::ptrdiff_t>(line.n)};
}

} // namespace

void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout)
{
  const double room = relative_room * lattice.spacing();
  const auto *const hole = std::get_if<RoundHole>(&cutout);
  const double notch = hole != nullptr ? 0. : std::get<Notch>(cutout).length;
  const auto in_piece = [&](const Eigen::Vector2d &X)
  {
    return hole != nullptr ? (X - Eigen::Vector2d(0.5 * lattice.length(), 0.)).norm() < hole->radius - room
                           : std::abs(X.y()) <= room && X.x() <= notch + room;
  };
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_occupied(place) && in_piece(lattice.reference(lattice.canonical_place(place))))
    {
      state.removed[place] = 1;
      state.held[place] = state.rollers[place] = 0;
      state.inverse_mass[place] = 0.;
    }
  for_each_bond(state, lattice,
                [&](const Bond &bond)
                {
                  if (state.removed[bond.near] != 0 || state.removed[bond.far] != 0)
                    state.bonds.remove(bond.near, bond.kind);
                });
  if (hole == nullptr) // through the slit between sites
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

std::vector<std::size_t> seed_sites(const TriangularLattice &lattice, const Seed &seed)
{
  std::vector<std::size_t> places = std::visit([&](const auto &shape) { return sites_of(shape, lattice); }, seed);
  require(!places.empty(), "there is no site in it");
  const double highest = 0.5 * lattice.height() - 2. * lattice.spacing();
  for (const std::size_t place : places)
    require(std::abs(lattice.reference(place).y()) <= highest,
            "it comes within two spacings of the lower or the upper edge of the sheet");
  return places;
}

} // namespace latcon::lattice
