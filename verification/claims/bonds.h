/// Bonds of the small sheets of claims as lists.
#pragma once

#include <vector>

#include "lattice/state.h"

namespace latcon::claims
{

/// Returns the bonds that are present, row by row.
inline std::vector<lattice::Bond> bonds(const lattice::State &state, const lattice::TriangularLattice &sheet)
{
  std::vector<lattice::Bond> list;
  lattice::for_each_bond(state, sheet, [&](const lattice::Bond &bond) { list.push_back(bond); });
  return list;
}

} // namespace latcon::claims
