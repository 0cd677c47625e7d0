#pragma once

#include <memory>
#include <vector>

#include "continuum/cauchy_born.h"
#include "continuum/fibre_memory.h"
#include "continuum/isotropic_network.h"
#include "continuum/lattice_gradient.h"
#include "continuum/mooney_rivlin.h"
#include "continuum/viscosity.h"
#include "lattice/material.h"
#include "verification/bridge/small_strain.h"

namespace latcon::bridge
{

/// Returns the Cauchy-Born law of a lattice: a fibre family for each bond direction, with weights c = A0 l / V
/// (theory-comparison.md, eq. (H.1)). Passes constants only; the continuum evaluates the law with its own code.
continuum::CauchyBorn cauchy_born(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// Returns the isotropic network law of a lattice: mean of its Cauchy-Born law over all rotations
/// (theory-continuum.md, eq. (C.50)). With Mooney-Rivlin bonds it is the Mooney-Rivlin law that agrees with the
/// lattice up to anisotropy, without calibration.
continuum::IsotropicNetwork isotropic_network(const lattice::TriangularLattice &lattice,
                                              const lattice::Material &material);

/// Returns the bond families of a lattice for the gradient energy of its long waves (theory-continuum.md, eq. (C.22)):
/// families as in cauchy_born, each with its undeformed length [m].
std::vector<continuum::BondFamily> bond_families(const lattice::TriangularLattice &lattice,
                                                 const lattice::Material &material);

/// Returns the viscous law of the dashpots of a lattice, with weights as in cauchy_born (theory-continuum.md, eq.
/// (C.41)); null if there are no dashpots.
/// @param gradient_length l_d of a gradient energy of the bonds, which the viscosity is to match [m]; 0: local
/// viscosity
std::unique_ptr<continuum::Viscosity> homogenised_viscosity(const lattice::TriangularLattice &lattice,
                                                            const lattice::Material &material,
                                                            double gradient_length = 0.);

/// Returns the Maxwell branches of a lattice as those of fibres, with weights as in cauchy_born()
/// (theory-comparison.md, eq. (H.1); theory-viscoelastic.md, eq. (V.1)); null if there are no branches. Branches are
/// numbered as in lattice::Simulation::mechanism_energies(): those of nearest-neighbour bonds first.
/// @param gradient_length as for homogenised_viscosity()
/// @throws std::invalid_argument for bonds with a memory of another program
std::unique_ptr<continuum::FibreMemory> homogenised_memory(const lattice::TriangularLattice &lattice,
                                                           const lattice::Material &material,
                                                           double gradient_length = 0.);

/// Lengths of the gradient continuum.
struct GradientLengths
{
  double lattice;           ///< l_d of the lattice gradient energy, the smallest that keeps it positive [m]
  double isotropic_static;  ///< l_s of the isotropic gradient energy [m]
  double isotropic_inertia; ///< l_d of the isotropic gradient energy [m]
};

/// Returns the lengths. The two isotropic lengths reproduce the dispersion of the longitudinal and the shear wave at F
/// = I, averaged over directions: l_s^2 = Lambda/24, l_d^2 = Lambda/12 with Lambda = sum c l^2 psi''(1) / sum c
/// psi''(1) over the bonds (theory-comparison.md, eqs. (H.7), (H.8)).
GradientLengths gradient_lengths(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// Plane-stress Mooney-Rivlin law fitted to a lattice: exact at small strain, least-squares fit of the energy along a
/// loading path.
struct Calibration
{
  double ratio;                           ///< r = C2 / (C1 + C2) [-] (theory-comparison.md, eq. (H.4))
  double energy_residual;                 ///< rms over the path of W_MR / W_CB - 1 [-]
  double smallest_acoustic_eigenvalue;    ///< smallest rho c^2 along the path over mu; strongly elliptic if > 0 [-]
  continuum::MooneyRivlin::Constants law; ///< [Pa]
};

/// Limit r of the interval [-r, r] in which the calibration searches the ratio [-]. Towards -1 and 1 one of the
/// constants from eq. (H.4) becomes negligible.
inline constexpr double largest_ratio = 0.9;

/// Calibrates r along F(t) = I + t (F - I), 0 < t <= 1, by least squares of the relative energy difference
/// (theory-comparison.md, eq. (H.5)), within [-largest_ratio, largest_ratio]; the result may be an end of this
/// interval. At F = I, where there is no path, the ratio is 0. @param F end of the loading path [-]
/// @throws continuum::NonPhysicalState if no ratio gives a law with an equilibrium thickness along the whole path
Calibration calibrate_mooney_rivlin(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                    const Eigen::Matrix2d &F);

/// Returns the law with the given ratio r, and its residuals along the same path.
/// @throws continuum::NonPhysicalState if the law has no equilibrium thickness somewhere on the path
Calibration with_ratio(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                       const Eigen::Matrix2d &F, double ratio);

/// Converts a deformation gradient to the type of the continuum.
dealii::Tensor<2, 2> to_continuum(const Eigen::Matrix2d &F);
/// Converts a tensor to the type of the lattice.
Eigen::Matrix2d to_lattice(const dealii::Tensor<2, 2> &F);

} // namespace latcon::bridge
