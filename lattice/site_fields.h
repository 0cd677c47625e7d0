#pragma once

#include "lattice/state.h"

namespace latcon::lattice
{

/// Continuum quantities at one site, from the bonds it has.
///
/// The area of a site is that of its reference Voronoi cell, (sqrt3 / 2) d^2, also at the edges of the sheet and at
/// cracks, where a site has fewer bonds and the values are sums over those.
struct SiteValues
{
  /// W [J/m^3]: half the energy of the law of every bond of the site over its reference volume. Exact in a homogeneous
  /// deformation. Energy stored in memories of bonds is excluded.
  double strain_energy_density = 0.;
  /// F_iJ [-]: least-squares fit of x_j - x_i = F (X_j - X_i) over the bonds of the site; identity where they do not
  /// fix it.
  Eigen::Matrix2d deformation_gradient = Eigen::Matrix2d::Identity();
  /// P_iJ = (1 / 2V) sum_j f_i R_J [Pa]: virial first Piola stress of elastic and viscous bond forces and of the
  /// overstress as of its last update, R reference.
  Eigen::Matrix2d first_piola_stress = Eigen::Matrix2d::Zero();
  /// P F^T / det F [Pa]: force per current length and reference thickness (a lattice has no thickness to change). Zero
  /// where F is not fixed or has det F <= 0.
  Eigen::Matrix2d cauchy_stress = Eigen::Matrix2d::Zero();
  unsigned int bonds = 0; ///< that the site has
  /// Share of its bonds the site has lost [-], 0 to 1.
  double damage = 0.;
};

/// Evaluates SiteValues, with what depends on lattice and material alone at hand.
class SiteEvaluator
{
public:
  /// The lattice must outlive this object.
  SiteEvaluator(const TriangularLattice &lattice, const Material &material);

  /// @param place of a site, not in the margin
  SiteValues at(const State &state, std::size_t place) const;

private:
  const TriangularLattice &lattice_;
  Material material_;
  std::array<MemoryStep, n_shells> at_rest_; // updates of the memories over no time
};

/// SiteValues of all sites, by their places; in the margin those of no bonds.
std::vector<SiteValues> site_fields(const State &state, const TriangularLattice &lattice, const Material &material);

} // namespace latcon::lattice
