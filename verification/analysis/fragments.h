#pragma once

#include <cstdint>
#include <vector>

#include "lattice/state.h"

namespace latcon::analysis
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

/// Of the bonds that are present.
Fragments find_fragments(const lattice::State &state, const lattice::TriangularLattice &lattice);

/// Bonds present beyond the stretch that would have broken them had they not been toughened: fibrils in the wake of a
/// crack, and flanks that were held together.
std::size_t n_overstretched_bonds(const lattice::State &state, const lattice::TriangularLattice &lattice,
                                  double breaking_stretch);

/// Length of crack that fibrils bridge: of the strips across the sheet, 4 d wide, that lie between X_from and X_to,
/// those in which bonds still lead from a held site below the middle to one above it without leaving the strip.
/// @param X_from, X_to reference [m]; the seed's tip and the tip, say
/// @return their width in all, reference [m]
double bridged_length(const lattice::State &state, const lattice::TriangularLattice &lattice, double X_from,
                      double X_to);

} // namespace latcon::analysis
