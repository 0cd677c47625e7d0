#pragma once

#include "lattice/material.h"
#include "verification/bridge/plane_waves.h"

namespace latcon::bridge
{

/// Dynamical matrix of an endless lattice at the homogeneous deformation F, over the mass of a site
/// (theory-comparison.md, eq. (W.1)): exact for waves of any length.
/// @param K referential wave vector [1/m]
WaveMatrices bloch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                            const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Both waves of the lattice at K, its dashpots left out.
std::array<PlaneWave, 2> bloch_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

} // namespace latcon::bridge
