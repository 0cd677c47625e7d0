#pragma once

#include "lattice/state.h"

namespace lattice
{

/// A 2 x 2 tensor at every place.
using TensorField = std::vector<Eigen::Matrix2d>;

/// Continuum quantities at the sites, from the bonds a site has. Zero in the margin and at removed sites.
///
/// The area of a site is that of its reference Voronoi cell, (sqrt3 / 2) d^2, also at the edges of the sheet and at
/// cracks, where a site has fewer bonds and the values are sums over those.
struct SiteFields
{
  /// W [J/m^3]: half the energy of every bond of a site over its reference volume. Exact in a homogeneous deformation.
  Field strain_energy_density;
  /// F_iJ [-]: least-squares fit of x_j - x_i = F (X_j - X_i) over the bonds of a site; identity where they do not fix
  /// it.
  TensorField deformation_gradient;
  /// P_iJ = (1 / 2V) sum_j f_i R_J [Pa]: virial first Piola stress of elastic and viscous bond forces, R reference.
  TensorField first_piola_stress;
  /// P F^T / det F [Pa]: force per current length and reference thickness (a lattice has no thickness to change).
  TensorField cauchy_stress;
  /// Share of its bonds a site has lost [-], 0 to 1.
  Field damage;
};

SiteFields site_fields(const State &state, const TriangularLattice &lattice, const Material &material);

} // namespace lattice
