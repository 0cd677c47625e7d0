#pragma once

#include <cstdint>
#include <vector>

#include "lattice/state.h"

namespace lattice
{

/// The pieces of a broken sheet: its sites, connected through the bonds that are present.
struct Fragments
{
  /// Of each place: 0 for the sheet, which is every piece that has a held site; 1, 2 ... for detached fragments, larger
  /// ones first, of equal ones that with the lowest site number. 0 at removed sites and in the margin as well. Where no
  /// site is held the largest piece counts as the sheet.
  std::vector<std::uint32_t> number;
  /// Sites of each detached fragment, that of number 1 first.
  std::vector<std::size_t> sizes;
};

Fragments find_fragments(const State &state, const TriangularLattice &lattice);

/// Bonds present whose stretch exceeds the stretch that would have broken them had they not been toughened: fibrils
/// that bridge the wake of a crack.
std::size_t n_bridging_bonds(const State &state, const TriangularLattice &lattice, double breaking_stretch);

} // namespace lattice
