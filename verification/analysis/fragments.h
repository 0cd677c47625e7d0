#pragma once

#include <cstdint>
#include <vector>

#include "lattice/breaking_rule.h"
#include "lattice/state.h"

namespace latcon::analysis
{

/// Connected pieces of a broken sheet: sites connected by bonds that are present.
struct Fragments
{
  /// Per slot: 0 for the sheet, which is every piece with a site that is held, or on rollers; 1, 2 ... for detached
  /// fragments, in the order of decreasing size, then of the lowest site number. 0 also at removed sites and in the
  /// margin. If there is no such site, the largest piece counts as the sheet.
  std::vector<std::uint32_t> number;
  /// Number of sites per detached fragment, number 1 first.
  std::vector<std::size_t> sizes;
};

/// Finds the fragments of a sheet from the bonds that are present.
Fragments find_fragments(const lattice::State &state, const lattice::TriangularLattice &lattice);

/// Returns the number of bonds present beyond the limit of `rule` for bonds that are stretched slowly and not
/// toughened, which are intact only because they were toughened: fibrils in the wake of a crack, and bonds in the
/// flanks.
std::size_t n_overstretched_bonds(const lattice::State &state, const lattice::TriangularLattice &lattice,
                                  const lattice::BreakingRule &rule);

/// Returns the length of a crack that fibrils bridge: of the strips across the sheet, 4 d wide, between X_from and
/// X_to, those in which bonds connect a held site, or one on rollers, below the middle to one above it within the
/// strip.
/// @param X_from, X_to reference [m], for example the tip of the seed and the tip
/// @return total width of these strips, reference [m]
double bridged_length(const lattice::State &state, const lattice::TriangularLattice &lattice, double X_from,
                      double X_to);

} // namespace latcon::analysis
