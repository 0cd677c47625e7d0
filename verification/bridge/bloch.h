#pragma once

#include "lattice/material.h"
#include "verification/bridge/plane_waves.h"

namespace latcon::bridge
{

/// Returns the dynamical matrices of an infinite lattice at the homogeneous deformation F, divided by the mass of a
/// site (theory-comparison.md, eq. (W.1)); exact for all wavelengths.
/// @param K referential wave vector [1/m]
WaveMatrices bloch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                            const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Returns both waves of the lattice at K, without dashpots.
std::array<PlaneWave, 2> bloch_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
