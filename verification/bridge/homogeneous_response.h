#pragma once

#include "lattice/material.h"

namespace latcon::bridge
{

/// Energy density [J/m^3] and first Piola stress [Pa] of a lattice in homogeneous deformation.
struct LatticeResponse
{
  double energy_density;
  Eigen::Matrix2d first_piola_stress;
};

/// Computes the response of a lattice with its simulator. @param sheet at least 12 by 12 spacings, so that the sites in
/// the middle have all their neighbours
LatticeResponse homogeneous_response(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                     const Eigen::Matrix2d &F);

} // namespace latcon::bridge
