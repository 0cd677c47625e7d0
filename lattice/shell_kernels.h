#pragma once

#include "lattice/row_kernels.h"

/// @file
/// The loops over the bonds of one shell that start in a row, for sheets whose bonds have their own factors, for each
/// instruction set as in row_kernels.h. They take each bond through the operations of bonds_of_row, times its factor.
namespace latcon::lattice::kernels
{

/// Adds to `sums` those over the bonds of a shell, and writes their forces to `row.force`.
/// @param shell 0 for nearest neighbours, 1 for next-nearest ones
void bonds_of_shell(const BondLaw &law, const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell,
                    RowSums &sums);

/// As any_event_ahead, for the bonds of one shell.
bool any_event_ahead_in_shell(const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell, double ahead);

} // namespace latcon::lattice::kernels
