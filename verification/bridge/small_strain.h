#pragma once

#include <cmath>

#include "lattice/material.h"

namespace latcon::bridge
{

/// Returns c = A0 l / V [-] of one bond direction, with the reference volume V of a site: there is one bond of each
/// direction per site.
[[nodiscard]] inline double bond_weight(const lattice::TriangularLattice &lattice, const lattice::Shell &shell,
                                        std::size_t kind)
{
  return lattice::cross_section(shell, lattice) * lattice.rest_length(kind) / lattice.site_area();
}

/// Returns psi'' n n + psi'/lam (1 - n n) [Pa] of a bond whose unit vector becomes lam n: its force, per section, on a
/// change of the vector.
[[nodiscard]] inline Eigen::Matrix2d bond_tangent(const lattice::BondLaw &law, const Eigen::Vector2d &deformed)
{
  const double stretch = deformed.norm();
  const Eigen::Matrix2d along = deformed * deformed.transpose() / (stretch * stretch);
  return lattice::stiffness(law, stretch) * along +
         lattice::force(law, stretch) / stretch * (Eigen::Matrix2d::Identity() - along);
}

/// Small-strain constants of the continuum of a lattice (theory-comparison.md, eqs. (H.2) and (H.3)): isotropic, lambda
/// = mu.
struct SmallStrain
{
  double shear_modulus;      ///< mu = (3/8) sum over shells of c psi''(1) [Pa], per reference thickness
  double shear_speed;        ///< c_S = sqrt(mu / rho) [m/s]
  double longitudinal_speed; ///< c_L = sqrt(3 mu / rho) [m/s]
};

/// Returns the small-strain constants of a lattice at F = I.
[[nodiscard]] inline SmallStrain small_strain(const lattice::TriangularLattice &lattice,
                                              const lattice::Material &material)
{
  // Three unit vectors 60 degrees apart have sum N N N N = (3/8) (dd + dd + dd).
  double mu = 0.;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      mu += 3. / 8. * bond_weight(lattice, *shell, number * lattice::n_kinds_per_shell) *
            lattice::stiffness(shell->law, 1.);
  return {mu, std::sqrt(mu / material.density), std::sqrt(3. * mu / material.density)};
}

} // namespace latcon::bridge
