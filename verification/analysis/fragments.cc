#include "verification/analysis/fragments.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <boost/pending/disjoint_sets.hpp>

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
  boost::disjoint_sets_with_storage<> connections(lattice.n_places());
  for_each_bond(state, lattice,
                [&](const lattice::Bond &bond)
                { connections.union_set(bond.near, lattice.canonical_place(bond.far)); });
  std::vector<Piece> all;
  std::map<std::size_t, std::size_t> numbers;
  for (const std::size_t place : lattice.sites())
  {
    if (state.removed[place] != 0)
      continue;
    const std::size_t number = numbers.try_emplace(connections.find_set(place), all.size()).first->second;
    if (number == all.size())
      all.emplace_back();
    all[number].places.push_back(place);
    all[number].held = all[number].held || (state.held[place] | state.rollers[place]) != 0;
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
                                  const lattice::BreakingRule &rule)
{
  std::size_t n = 0;
  for_each_bond(state, lattice,
                [&](const lattice::Bond &bond)
                {
                  const double strength = state.strength.of(bond.near, bond.kind),
                               stiffness = state.stiffness.of(bond.near, bond.kind);
                  if (stretch(state, lattice, bond) > rule.limit({lattice.shell(bond.kind), 1., strength, stiffness}))
                    ++n;
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

  boost::disjoint_sets_with_storage<> connections(lattice.n_places());
  for_each_bond(state, lattice,
                [&](const lattice::Bond &bond)
                {
                  if (strip_of(bond.near) == strip_of(bond.far))
                    connections.union_set(bond.near, bond.far);
                });
  // Pieces of strips with a held site below the middle, and the strips in which such a piece has one above it.
  std::vector<std::uint8_t> begins(lattice.n_places(), 0);
  std::vector<std::uint8_t> bridged(static_cast<std::size_t>(std::max<std::ptrdiff_t>(n_strips, 0)), 0);
  for (const bool above : {false, true})
    for (std::size_t place = 0; place < lattice.n_places(); ++place)
    {
      const double Y = lattice.reference(place).y();
      if (!lattice.is_site(place) || (state.held[place] | state.rollers[place]) == 0 || !(above ? Y > 0. : Y < 0.))
        continue;
      const std::ptrdiff_t strip = strip_of(place);
      if (!above)
        begins[connections.find_set(place)] = 1;
      else if (strip >= 0 && strip < n_strips && begins[connections.find_set(place)] != 0)
        bridged[static_cast<std::size_t>(strip)] = 1;
    }
  return width * static_cast<double>(std::count(bridged.begin(), bridged.end(), 1));
}

} // namespace latcon::analysis
