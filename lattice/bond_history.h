#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "lattice/bonds/bond_memory.h"
#include "lattice/row_partition.h"

namespace latcon::lattice
{

/// History of bonds with a memory, by the place where they start: their stretch and the variables of their memory at
/// the last update. Nothing is stored for kinds of bonds without a memory.
///
/// A rank holds values for the bonds that it computes: those that start in its own rows, and in the rows below
/// them that bonds reach from, which the rank that owns those rows updates alike.
struct BondHistory
{
  /// Bonds of one kind.
  struct Kind
  {
    Field stretch;                ///< [-]; 0 for absent bonds
    std::vector<Field> variables; ///< one field per variable of BondMemory; none: no memory
  };
  std::vector<Kind> kinds; ///< none: no bond has a memory

  bool remembers(std::size_t kind) const { return !kinds.empty() && !kinds[kind].variables.empty(); }

  /// Returns whether no bond remembers anything.
  bool empty() const
  {
    return std::all_of(kinds.begin(), kinds.end(), [](const Kind &kind) { return kind.variables.empty(); });
  }

  /// Variables of one bond, 0 beyond.
  std::array<double, max_history_variables> variables_of(std::size_t place, std::size_t kind) const
  {
    std::array<double, max_history_variables> variables{};
    for (std::size_t v = 0; v < kinds[kind].variables.size(); ++v)
      variables[v] = kinds[kind].variables[v][place];
    return variables;
  }
};

} // namespace latcon::lattice
