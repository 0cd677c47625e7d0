#pragma once

#include "lattice/row_kernels.h"

/// @file
/// Square root, quotient and law of a bond alone, for each instruction set as in lattice/row_kernels.h: the least that
/// a step needs for its bonds, without gathering, motion and monitoring.
namespace latcon::lattice::kernels
{

/// Forces of n bonds, by the operations of bonds_of_row and thus with the same bits.
/// @param n a multiple of TriangularLattice::row_alignment
/// @param dx, dy from the near to the far end [m], not both 0 @param dvx, dvy the same of velocities [m/s]
/// @param fx, fy forces on the near ends [N/m]
/// @return power of their dashpots [W/m]
double bond_formulas(const MooneyRivlinBond &law, const BondConstants &bond, std::size_t n, const double *dx,
                     const double *dy, const double *dvx, const double *dvy, double *fx, double *fy);

} // namespace latcon::lattice::kernels
