#pragma once

#include <string>

#include "lattice/material.h"

namespace latcon::bridge
{

/// Returns the name of the shells of a lattice in results: "NN", then "+NNN" with next-nearest neighbours and "+3NN"
/// with third-nearest ones.
[[nodiscard]] std::string shells_name(const lattice::Material &material);

/// Returns c = A0 l / V [-] of one bond direction, with the reference volume V of a site: there is one bond of each
/// direction per site.
[[nodiscard]] double bond_weight(const lattice::TriangularLattice &lattice, const lattice::Shell &shell,
                                 std::size_t kind);

/// Small-strain constants of the continuum of a lattice (theory-comparison.md, eqs. (H.2) and (H.3)): isotropic, lambda
/// = mu.
struct SmallStrain
{
  double shear_modulus;      ///< mu = (3/8) sum over shells of c psi''(1) [Pa], per reference thickness
  double shear_speed;        ///< c_S = sqrt(mu / rho) [m/s]
  double longitudinal_speed; ///< c_L = sqrt(3 mu / rho) [m/s]
};

/// Returns the small-strain constants of a lattice at F = I.
[[nodiscard]] SmallStrain small_strain(const lattice::TriangularLattice &lattice, const lattice::Material &material);

} // namespace latcon::bridge
