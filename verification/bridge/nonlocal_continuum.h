#pragma once

#include <vector>

#include "lattice/material.h"

namespace latcon::bridge
{

/// Returns the rings with the lengths of the shells of a material. @param d spacing of the lattice [m]
/// @param half_width of the arcs about the lattice's directions [rad]
std::vector<lattice::Ring> rings_of(const lattice::Material &material, double d, lattice::Orientation orientation,
                                    double half_width = M_PI / 6.);

/// Returns c [-] of a ring: its energy density is c times the mean of psi (theory-comparison.md, eq. (H.25)).
double ring_weight(const lattice::Material &material, double d, const lattice::Ring &ring);

/// A nonlocal continuum without end, as sums over the half-bonds of its stencil (theory-comparison.md, eq. (H.25)).
class NonlocalContinuum
{
public:
  /// @param stencil bonds of shells that the material lacks are left out @param d spacing of the lattice [m]
  NonlocalContinuum(std::vector<lattice::HalfBond> stencil, const lattice::Material &material, double d);

  double energy(const Eigen::Matrix2d &F) const;                      ///< energy density [J/m^3]
  Eigen::Matrix2d first_piola_stress(const Eigen::Matrix2d &F) const; ///< [Pa]

  /// Matrix of plane waves [1/s^2], without dashpots; that of WaveMatrices. @param K referential wave vector [1/m]
  Eigen::Matrix2d wave_stiffness(const Eigen::Matrix2d &F, const Eigen::Vector2d &K) const;

  /// Squared intrinsic length [m^2]: mean of |R|^2, weighted with the stiffness of bonds at rest.
  double squared_length() const;

  /// Energy [J/m^2] of a straight cut along x through bonds that all have one stretch (theory-comparison.md, eq.
  /// (H.28)).
  double cut_energy(double stretch) const;

private:
  const lattice::Shell &shell(const lattice::HalfBond &bond) const { return *material_.in_shell(bond.shell); }
  double weight(const lattice::HalfBond &bond) const; // c [-]

  std::vector<lattice::HalfBond> stencil_;
  lattice::Material material_;
  double d_;
};

/// Quantity of rings that are as wide as the spacing h of their grid, beside that of rings without width.
struct RingValue
{
  double limit;   ///< for h = 0
  double smooth;  ///< with the term of order h^2
  double scatter; ///< bound on the remainder, of order h^(3/2): scatter of the points of a grid in a ring
};

/// Returns the squared intrinsic length [m^2] of rings in all directions on a grid (theory-comparison.md, eq. (H.27)).
RingValue ring_squared_length(const lattice::Material &material, double d, const lattice::Grid &grid);

/// Returns the energy of a straight cut along x [J/m^2] through rings in all directions on a grid that is not rotated
/// (theory-comparison.md, eq. (H.28)).
RingValue ring_cut_energy(const lattice::Material &material, double d, const lattice::Grid &grid, double stretch);

} // namespace latcon::bridge
