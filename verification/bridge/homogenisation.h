#pragma once

#include <memory>
#include <vector>

#include "continuum/cauchy_born.h"
#include "continuum/isotropic_network.h"
#include "continuum/lattice_gradient.h"
#include "continuum/mooney_rivlin.h"
#include "continuum/viscosity.h"
#include "lattice/material.h"

namespace latcon::bridge
{

/// Small-strain constants of a lattice's continuum (theory-comparison.md, eqs. (H.2) and (H.3)): isotropic, lambda =
/// mu.
struct SmallStrain
{
  double shear_modulus;      ///< mu = (3/8) sum over shells of c psi''(1) [Pa], per reference thickness
  double shear_speed;        ///< c_S = sqrt(mu / rho) [m/s]
  double longitudinal_speed; ///< c_L = sqrt(3 mu / rho) [m/s]
};

/// Of a lattice at F = I.
SmallStrain small_strain(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// The Cauchy-Born law of a lattice: a fibre family for each of its bond directions, weights c = A0 l / V
/// (theory-comparison.md, eq. (H.1)). Constants alone are handed over; the continuum evaluates them with its own code.
continuum::CauchyBorn cauchy_born(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// The network of a lattice's bonds with all directions alike, the mean of its Cauchy-Born law over all rotations of
/// the lattice (theory-comparison.md, eq. (H.13)). With Mooney-Rivlin bonds it is the Mooney-Rivlin law that agrees
/// with the lattice but for its anisotropy; nothing is calibrated.
continuum::IsotropicNetwork isotropic_network(const lattice::TriangularLattice &lattice,
                                              const lattice::Material &material);

/// The bonds of a lattice, for the gradient energy that its long waves have (theory-comparison.md, eq. (H.6)): families
/// as in cauchy_born, with the undeformed length [m] of each.
std::vector<continuum::BondFamily> bond_families(const lattice::TriangularLattice &lattice,
                                                 const lattice::Material &material);

/// The dashpots of a lattice as a viscosity of its continuum, weights as in cauchy_born (theory-comparison.md, eq.
/// (H.9)); null if no bond has one.
std::unique_ptr<continuum::Viscosity> homogenised_viscosity(const lattice::TriangularLattice &lattice,
                                                            const lattice::Material &material);

/// Lengths of the gradient continuum.
struct GradientLengths
{
  double lattice;           ///< l_d of the lattice's own gradient energy, the shortest that keeps it positive [m]
  double isotropic_static;  ///< l_s of the isotropic gradient energy [m]
  double isotropic_inertia; ///< l_d that goes with it [m]
};

/// The isotropic pair gives the longitudinal and the shear wave their dispersion at F = I, averaged over directions:
/// l_s^2 = Lambda/24, l_d^2 = Lambda/12 with Lambda = sum c l^2 psi''(1) / sum c psi''(1) over the bonds
/// (theory-comparison.md, eqs. (H.7), (H.8)).
GradientLengths gradient_lengths(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// The plane-stress Mooney-Rivlin law of the textbooks fitted to a lattice: exact at small strain, closest in energy
/// along a loading path.
struct Calibration
{
  double ratio;                           ///< r = C2 / (C1 + C2) [-] (theory-comparison.md, eq. (H.4))
  double energy_residual;                 ///< rms over the path of W_MR / W_CB - 1 [-]
  double largest_energy_residual;         ///< largest of |W_MR / W_CB - 1| [-]
  double smallest_acoustic_eigenvalue;    ///< smallest rho c^2 along the path over mu; strongly elliptic if > 0 [-]
  continuum::MooneyRivlin::Constants law; ///< [Pa]
};

/// End of the interval [-r, r] of ratios in which the calibration looks for the best [-]: towards -1 and 1 one of the
/// constants that eq. (H.4) gives loses all weight beside the other.
inline constexpr double largest_ratio = 0.9;

/// Calibrates r along F(t) = I + t (F - I), 0 < t <= 1, by least squares of the relative energy difference
/// (theory-comparison.md, eq. (H.5)), within [-largest_ratio, largest_ratio]: the best ratio may be an end of that.
/// Without a path, at F = I, the ratio is 0. @param F end of the loading path [-]
/// @throws continuum::NonPhysicalState if no ratio gives a law that has a thickness all along the path
Calibration calibrate_mooney_rivlin(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                    const Eigen::Matrix2d &F);

/// The same for a ratio r that is given, its residuals along the same path.
/// @throws continuum::NonPhysicalState if the law breaks down on the path
Calibration with_ratio(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                       const Eigen::Matrix2d &F, double ratio);

/// The same deformation gradient or vector in the other library's type.
dealii::Tensor<2, 2> to_continuum(const Eigen::Matrix2d &F);
/// Likewise, the other way.
Eigen::Matrix2d to_lattice(const dealii::Tensor<2, 2> &F);

} // namespace latcon::bridge
