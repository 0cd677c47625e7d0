#pragma once

#include "lattice/row_kernels.h"

/// @file
/// The loops over the bonds of one shell that start in a row, for each instruction set as in row_kernels.h: for sheets
/// whose bonds have their own factors, and for third-nearest neighbours. They take each bond through the operations of
/// bonds_of_row, times its factor.
namespace latcon::lattice::kernels
{

/// Adds to `sums` those over the bonds of a shell, and writes their forces to `row.force`.
/// @param row its `bonds` are the words of this shell @param shell its number below n_shells
void bonds_of_shell(const BondLaw &law, const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell,
                    RowSums &sums);

/// As any_event_ahead, for the bonds of one shell.
bool any_event_ahead_in_shell(const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell, double ahead);

/// Adds to a component of the forces on the n sites of a row what bonds of the third shell do, [kind of the
/// shell][site] as in gather_row.
void add_third_shell(std::size_t n, const std::array<const double *, n_kinds_per_shell> &start,
                     const std::array<const double *, n_kinds_per_shell> &end, double *total);

} // namespace latcon::lattice::kernels
