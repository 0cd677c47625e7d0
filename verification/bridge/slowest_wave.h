#pragma once

#include "lattice/material.h"

namespace latcon::bridge
{

/// Slowest, or unstable, wave of an infinite lattice.
struct SlowestWave
{
  double squared_speed; ///< smallest w^2 / k^2 [m^2/s^2] of all waves; the lattice is unstable unless positive; NaN
                        ///< if any value is NaN
  Eigen::Vector2d wave_vector; ///< referential K of that wave [1/m]
};

/// Finds the slowest of all waves about the homogeneous deformation F, without dashpots: smallest eigenvalue of the
/// Bloch matrix (theory-comparison.md, eq. (W.1)) over k^2. A descent starts at each minimum of a polar grid of wave
/// vectors, 1.5 degrees by 0.07/d, that covers the Brillouin zone. A sheet in which it is not positive buckles: its
/// homogeneous equilibrium is unstable. @param F det F > 0
SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F);

} // namespace latcon::bridge
