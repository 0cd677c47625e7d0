/// Responses of a lattice in homogeneous deformation, and their means over rotations and directions.
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

/// Number of rotations of a triangular lattice over which means are taken, equispaced over its symmetry angle of 60
/// degrees. At principal stretches l1 >= l2, the aliasing of higher harmonics is of order rho^96 in the mean and rho^48
/// in the bound, with rho = (l1 - l2)/(l1 + l2).
constexpr int n_lattice_rotations = 32;

/// Returns rotation R number k in [0, n_lattice_rotations) of the reference configuration of the lattice [-]. A bond N
/// becomes R N, so the rotated lattice has the energy W(F R) and the first Piola stress P(F R) R^T, with W and P of the
/// original lattice.
Eigen::Matrix2d lattice_rotation(int k);

/// Mean over rotations or directions, and bound on the distance from it.
struct RotationMean
{
  Eigen::VectorXd mean;
  double bound; ///< on the Euclidean distance from the mean, in the units of the values
};

/// Computes mean and bound (theory-comparison.md, eqs. (H.14), (H.15)). @param values a column of values for each
/// rotation 0, 1 ... n_lattice_rotations - 1
RotationMean rotation_mean(const Eigen::MatrixXd &values);

/// Returns such columns of the dynamical matrices D of a lattice without dashpots (theory-comparison.md, eq. (W.1)):
/// turned by R, it has that of the lattice as it stands at F R for the wave R^T K.
Eigen::MatrixXd rotated_bloch_stiffness(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                        const Eigen::Matrix2d &F, const Eigen::Vector2d &K);

/// Number of directions of a bond over which means are taken, equispaced over half a turn. Aliasing of higher harmonics
/// as for rotations.
constexpr int n_bond_directions = 3 * n_lattice_rotations;

/// Returns the unit vector along direction number k in [0, n_bond_directions) [-].
Eigen::Vector2d bond_direction(int k);

/// Computes the mean over all directions of a bond, and a bound on the distance from it of a mean over bonds in some
/// directions, of which it is known only that their weights are positive and their fourth moments isotropic
/// (theory-comparison.md, eq. (H.26)). @param values a column of values for each direction
RotationMean direction_mean(const Eigen::MatrixXd &values);

} // namespace latcon::bridge
