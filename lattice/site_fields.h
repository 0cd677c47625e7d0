#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "lattice/state.h"

namespace latcon::lattice
{

/// Continuum quantities at one site, from the bonds it has.
///
/// The area of a site is TriangularLattice::site_area(), also at the edges of the sheet and at cracks, where a site has
/// fewer bonds and the values are sums over those.
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

/// Values at one site. @param place not in the margin
SiteValues site_values(const State &state, const TriangularLattice &lattice, const Material &material,
                       std::size_t place);

/// SiteValues of all sites, by their places; in the margin those of no bonds.
std::vector<SiteValues> site_fields(const State &state, const TriangularLattice &lattice, const Material &material);

/// G_iJK = d^2 x_i / dX_J dX_K at a site [1/m], symmetric in J, K.
struct StrainGradient
{
  Eigen::Matrix2d x; ///< G_xJK
  Eigen::Matrix2d y; ///< G_yJK
};

/// Second derivatives of the positions by local least squares (theory.md, eq. (N.2)): the quadratic
///
///     x_j - x_i = F R + (1/2) G : R R,   R = X_j - X_i
///
/// is fitted to the bonded nearest and next-nearest neighbours j, all with one weight; third-nearest ones, farther off,
/// add nothing to what is local. Exact where the positions are a quadratic
/// function of X. The weights depend on which bonds a site has and on nothing else; they are found once for each
/// such set.
class StrainGradientFit
{
public:
  /// The lattice must outlive this object.
  explicit StrainGradientFit(const TriangularLattice &lattice) : lattice_(lattice) {}

  /// None where the bonds left do not fix a quadratic: a flank of a lattice of nearest neighbours has four, and five
  /// are needed. None on sheets other than the triangular lattice: not supported.
  /// @param place of a site, not in the margin
  std::optional<StrainGradient> at(const State &state, std::size_t place);

private:
  static constexpr std::size_t n_kinds = 2 * n_kinds_per_shell; // of bonds
  static constexpr std::size_t n_neighbours = 2 * n_kinds;
  /// Rows: G_xx, G_xy, G_yy; columns: neighbours in the order of bond kinds, forward ones first; zero for those
  /// missing.
  using Weights = Eigen::Matrix<double, 3, n_neighbours>;

  /// None if the bonds do not fix a quadratic.
  std::optional<Weights> weights(unsigned int bonds) const;

  const TriangularLattice &lattice_;
  std::unordered_map<unsigned int, std::optional<Weights>> weights_;
};

} // namespace latcon::lattice
