#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/row_kernels.h"

/// @file
/// The loops over the bonds of one half-bond of a stencil that start in a row, for each instruction set and with the
/// same bits on all, as in row_kernels.h.
namespace latcon::lattice::kernels
{

/// The bonds of one half-bond that start at the n sites of a row. Arrays are readable, and those written to writable,
/// to the end of the last block of row_alignment sites, where no bonds are.
struct BondsOfHalfBond
{
  std::size_t n;                            ///< sites
  const double *x, *y, *vx, *vy;            ///< of sites [m, m/s]
  std::ptrdiff_t shift;                     ///< from a site to the far end of its bond
  const std::uint64_t *present, *toughened; ///< words of sites, with the bit below for each bond
  std::uint64_t bit;
};

/// Writes the forces on the near ends [N/m] to fx and fy (theory.md, eq. (L.3)). @return power of the dashpots [W/m]
double bonds_of_half_bond(const BondLaw &law, const BondConstants &bond, const BondsOfHalfBond &row, double *fx,
                          double *fy);

/// Returns whether one of the bonds will be longer than its limit after its ends have moved for `ahead` [s] at their
/// velocities. @param breaking,toughened lengths of bonds at which they break [m]
bool any_longer_ahead(const BondsOfHalfBond &row, double ahead, double breaking, double toughened);

} // namespace latcon::lattice::kernels
