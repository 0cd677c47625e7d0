#pragma once

#include "lattice/bonds/bond_memory.h"
#include "lattice/row_kernels.h"

/// @file
/// The loops over the bonds of a row that have a memory, for each instruction set as in row_kernels.h. Rows whose bonds
/// have none do not come here.
namespace latcon::lattice::kernels
{

/// History of the bonds of one kind that start in a row, by places counted from its first site.
template <class Pointer>
struct RememberedRow
{
  Pointer stretch;                                     ///< at the last update [-]
  std::array<Pointer, max_history_variables> variable; ///< of BondMemory
};

/// History of the bonds of a kind, one of BondHistory, that start at a place and the places after it.
template <class Pointer, class Kind>
RememberedRow<Pointer> remembered_from(Kind &kind, std::size_t place)
{
  RememberedRow<Pointer> row{kind.stretch.data() + place, {}};
  for (std::size_t v = 0; v < kind.variables.size(); ++v)
    row.variable[v] = kind.variables[v].data() + place;
  return row;
}

/// Adds the overstress of the bonds of one kind that start in a row to their `force`, the present stretch being reached
/// in the duration of `step` since the last update.
/// @param power what each mechanism dissipates in them is added [W/m], or [J/m] for energies; see BondMemory
void add_overstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                    const RememberedRow<const double *> &remembered, double *power);

/// Also updates what the bonds remember to the present stretch. Absent bonds remember 0.
void add_overstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                    const RememberedRow<double *> &remembered, double *power);

/// Overstress of one bond.
struct Overstress
{
  double axial;                                          ///< [N/m], tension positive
  std::array<double, max_history_variables> dissipation; ///< of each mechanism, 0 beyond [W/m], or [J/m]
};
/// By the operations of add_overstress, so that both have the same bits. @param place of the remembered row
Overstress overstress(const MemoryStep &step, const BondConstants &bond, double stretch, std::size_t place,
                      const RememberedRow<const double *> &remembered);

} // namespace latcon::lattice::kernels
