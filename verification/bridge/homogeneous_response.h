#pragma once

#include "lattice/material.h"

namespace latcon::bridge
{

/// Energy density [J/m^3] and first Piola stress [Pa] of a lattice in homogeneous deformation, by its simulator.
struct LatticeResponse
{
  double energy_density;
  Eigen::Matrix2d first_piola_stress;
};

/// Of a sheet of 12 by 12 spacings or more, whose middle sites have all their neighbours.
/// @throws std::invalid_argument if F leaves no bond its length
LatticeResponse homogeneous_response(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                     const Eigen::Matrix2d &F);

} // namespace latcon::bridge
