#pragma once

#include "lattice/material.h"

namespace latcon::bridge
{

/// The wave of an endless lattice that comes nearest to standing still, or grows.
struct SlowestWave
{
  double squared_speed; ///< smallest w^2 / k^2 [m^2/s^2] of all waves; not positive: the lattice is unstable; not a
                        ///< number if one is none
  Eigen::Vector2d wave_vector; ///< referential K of that wave [1/m]
};

/// The slowest of all waves about the homogeneous deformation F, dashpots left out: smallest eigenvalue of the Bloch
/// matrix (theory-comparison.md, eq. (W.1)) over k^2, on a polar grid of wave vectors that covers the Brillouin zone. A
/// sheet in which it is not positive buckles: no equilibrium stays homogeneous there. @param F det F > 0
SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F);

} // namespace latcon::bridge
