#pragma once

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
    for (const Kind &kind : kinds)
      if (!kind.variables.empty())
        return false;
    return true;
  }

  /// Rows whose bonds a rank updates, by increasing number.
  static std::vector<std::size_t> rows(const RowPartition &band);

  /// Copies the variables of one bond to `to`, which has room for max_history_variables.
  void variables_of(std::size_t place, std::size_t kind, double *to) const
  {
    for (const Field &variable : kinds[kind].variables)
      *to++ = variable[place];
  }
};

} // namespace latcon::lattice
