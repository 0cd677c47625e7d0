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

// Y of all lines along x on which sites stand, increasing.
std::vector<double> lines_of_sites(const TriangularLattice &lattice)
{
  std::vector<double> lines;
  const bool along = lattice.orientation() == Orientation::rows_along_crack;
  for (std::size_t row = 0; row < (along ? lattice.rows() : 2); ++row)
    for (std::size_t column = 0; column < (along ? 1 : lattice.sites_in_row(row)); ++column)
      lines.push_back(lattice.reference(lattice.index(row, column)).y());
  std::sort(lines.begin(), lines.end());
  return lines;
}

// Number of the nearest of increasing coordinates; of two that are equally near, the larger one.
std::size_t nearest(const std::vector<double> &coordinates, double wanted, double room)
{
  std::size_t best = 0;
  for (std::size_t i = 1; i < coordinates.size(); ++i)
    if (std::abs(coordinates[i] - wanted) <= std::abs(coordinates[best] - wanted) + room)
      best = i;
  return best;
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
  const std::vector<double> lines = lines_of_sites(lattice);
  const double y = lines[nearest(lines, line.offset, room)];
  const Eigen::Vector2d lower(-lattice.spacing(), y - room), upper(lattice.length() + lattice.spacing(), y + room);
  const std::vector<std::size_t> candidates = sites_in({lower, upper}, lattice);
  std::vector<double> positions;
  for (const std::size_t place : candidates)
    positions.push_back(lattice.reference(place).x());
  const std::size_t first = nearest(positions, line.position, room);
  require(first + line.n <= candidates.size(), "it goes beyond the right end of the sheet");
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(line.n)};
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
  // Through the slit between sites.
  const auto through_notch = [&](const Eigen::Vector2d &X, const Eigen::Vector2d &R)
  { return hole == nullptr && X.y() * (X.y() + R.y()) < 0. && X.x() - X.y() / R.y() * R.x() <= notch + room; };
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
                  if (state.removed[bond.near] != 0 || state.removed[bond.far] != 0 ||
                      through_notch(lattice.reference(bond.near), lattice.bond_vector(bond)))
                    state.bonds.remove(bond.near, bond.kind);
                });
}

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
  require(!places.empty(), "there is no site in it");
  const double highest = 0.5 * lattice.height() - 2. * lattice.spacing();
  for (const std::size_t place : places)
    require(std::abs(lattice.reference(place).y()) <= highest,
            "it comes within two spacings of the lower or the upper edge of the sheet");
  return places;
}

} // namespace latcon::lattice
