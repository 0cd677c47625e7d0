#pragma once

#include <functional>

#include "lattice/material.h"

namespace latcon::bridge
{

/// Energy density [J/m^3] and first Piola stress [Pa] of a sheet in homogeneous deformation.
struct LatticeResponse
{
  double energy_density;
  Eigen::Matrix2d first_piola_stress;
};

/// First Piola stress [Pa] of a sheet in homogeneous deformation, from the forces of its bonds on the sites of its
/// edges.
/// @param sheet as for homogeneous_response() @param material of its bonds
/// @param force on the site at a slot, per sheet thickness [N/m]
Eigen::Matrix2d edge_stress(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                            const std::function<Eigen::Vector2d(std::size_t place)> &force);

/// Computes the response of a lattice, or of a sheet with another stencil, with its simulator. @param sheet at least 12
/// by 12 spacings of the lattice, so that the sites in the middle have all their neighbours
LatticeResponse homogeneous_response(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                     const Eigen::Matrix2d &F);

} // namespace latcon::bridge
