#pragma once

#include "lattice/row_kernels.h"

/// @file
/// The loops over the bonds of any half-bonds of a stencil that start in a row, for each instruction set and with the
/// same bits on all, as in row_kernels.h. They take each bond through the operations of bonds_of_row(), times its
/// factor.
namespace latcon::lattice::kernels
{

/// Computes the forces of the bonds of all kinds of a row, which have one law, and adds to `sums` those over the bonds.
/// @param row of one kind, or of the n_kinds_per_shell of a shell
void bonds_of_stencil(const BondLaw &law, const RowOfBonds &row, RowSums &sums);

/// Adds a component of the forces of n bonds of a kind to the sums of their near ends, unless null, and takes it from
/// those of their far ends, which may be other places of the same array.
void scatter(std::size_t n, const double *force, double *near, double *far);

/// Returns whether one of the bonds of all kinds of a row will be past its limit, or will have retracted, after its
/// ends have moved for `ahead` [s] at their velocities. Does not use the forces.
bool any_event_ahead(const RowOfBonds &row, double ahead);

/// Returns whether one of the bonds of all kinds of a row has at most a stretch of `stretch` [-] now, or will have it
/// in `ahead` [s] at its present rate. Does not use the forces.
bool any_short_ahead(const RowOfBonds &row, double ahead, double stretch);

/// A bond's force, one at a time: the operations of the loops, so that both have the same bits.
struct BondForce
{
  double x, y;   ///< on the near end [N/m], the opposite on the far end
  double nx, ny; ///< direction from the near to the far end, times the ratio of lengths
  double stretch;
  double viscous_power; ///< [W/m]
};
/// Returns the force of a bond whose ends are at a distance (dx, dy) [m] and move apart with (dvx, dvy) [m/s].
/// @param factor,length_ratio of the bond, see BondsOfKind
BondForce bond_force(const BondLaw &law, const BondConstants &bond, double factor, double dx, double dy, double dvx,
                     double dvy, double length_ratio = 1.);

} // namespace latcon::lattice::kernels
