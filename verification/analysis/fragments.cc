#include "verification/analysis/fragments.h"

#include <algorithm>
#include <cmath>

namespace latcon::analysis
{
namespace
{

struct Piece
{
  std::vector<std::size_t> places;
  bool held = false;
};

// Finds the connected pieces, in the order of their lowest sites.
std::vector<Piece> pieces(const lattice::State &state, const lattice::TriangularLattice &lattice)
{
  std::vector<std::vector<std::size_t>> neighbours(lattice.n_places());
  for_each_bond(state, lattice,
                [&](const lattice::Bond &bond)
                {
                  neighbours[bond.near].push_back(lattice.canonical_place(bond.far));
                  neighbours[lattice.canonical_place(bond.far)].push_back(bond.near);
                });
  std::vector<Piece> all;
  std::vector<std::uint8_t> seen(lattice.n_places(), 0);
  for (std::size_t start = 0; start < lattice.n_places(); ++start)
  {
    if (!lattice.is_site(start) || state.removed[start] != 0 || seen[start] != 0)
      continue;
    Piece piece;
    piece.places.push_back(start);
    seen[start] = 1;
    for (std::size_t i = 0; i < piece.places.size(); ++i)
    {
      const std::size_t place = piece.places[i];
      piece.held = piece.held || state.held[place] != 0;
      for (const std::size_t next : neighbours[place])
        if (seen[next] == 0)
        {
          seen[next] = 1;
          piece.places.push_back(next);
        }
    }
    all.push_back(std::move(piece));
  }
  return all;
}

} // namespace

Fragments find_fragments(const lattice::State &state, const lattice::TriangularLattice &lattice)
{
  std::vector<Piece> all = pieces(state, lattice);
  std::stable_sort(all.begin(), all.end(),
                   [](const Piece &a, const Piece &b) { return a.places.size() > b.places.size(); });
  if (!all.empty() && std::none_of(all.begin(), all.end(), [](const Piece &piece) { return piece.held; }))
    all.front().held = true;
  Fragments fragments;
  fragments.number.assign(lattice.n_places(), 0);
  for (const Piece &piece : all)
    if (!piece.held)
    {
      fragments.sizes.push_back(piece.places.size());
      for (const std::size_t place : piece.places)
        fragments.number[place] = static_cast<std::uint32_t>(fragments.sizes.size());
    }
  return fragments;
}

std::size_t n_overstretched_bonds(const lattice::State &state, const lattice::TriangularLattice &lattice,
                                  double breaking_stretch)
{
  std::size_t n = 0;
  for_each_bond(state, lattice,
                [&](const lattice::Bond &bond) {
                  n +=
                    stretch(state, lattice, bond) > breaking_stretch * state.strength.of(bond.near, bond.kind) ? 1 : 0;
                });
  return n;
}

double bridged_length(const lattice::State &state, const lattice::TriangularLattice &lattice, double X_from,
                      double X_to)
{
  const double width = 4. * lattice.lattice_spacing();
  const auto n_strips = static_cast<std::ptrdiff_t>(std::floor((X_to - X_from) / width));
  const auto strip_of = [&](std::size_t place)
  { return static_cast<std::ptrdiff_t>(std::floor((lattice.reference(place).x() - X_from) / width)); };

  // Held sites below the middle, and all sites connected to them.
  std::vector<std::uint8_t> reached(lattice.n_places(), 0);
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_site(place) && state.held[place] != 0 && lattice.reference(place).y() < 0.)
    {
      reached[place] = 1;
      places.push_back(place);
    }
  std::vector<std::uint8_t> bridged(static_cast<std::size_t>(std::max<std::ptrdiff_t>(n_strips, 0)), 0);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const std::size_t place = places[i];
    const std::ptrdiff_t strip = strip_of(place);
    if (strip < 0 || strip >= n_strips)
      continue;
    if (state.held[place] != 0 && lattice.reference(place).y() > 0.)
      bridged[static_cast<std::size_t>(strip)] = 1;
    for_each_bond_of_site(state, lattice, place,
                          [&](const lattice::Bond &bond)
                          {
                            const std::size_t other = bond.near == place ? bond.far : bond.near;
                            if (reached[other] == 0 && strip_of(other) == strip)
                            {
                              reached[other] = 1;
                              places.push_back(other);
                            }
                          });
  }
  return width * static_cast<double>(std::count(bridged.begin(), bridged.end(), 1));
}

} // namespace latcon::analysis
