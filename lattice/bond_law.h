#pragma once

#include <limits>
#include <stdexcept>
#include <variant>

#include "lattice/custom_bond.h"

/// @file
/// Bond laws. A law is energy, force and stiffness as functions of the bond stretch, and nothing else.
///
/// Formulas of forces are in bond_force.inc, since the hot loop needs them for vectors as well.
///
/// A bond of rest length l and cross-section A0 stores A0 l psi(lam), lam = |x_j - x_i| / l > 0 being its stretch, and
/// pulls with the axial force A0 psi'(lam), tension positive. A law gives psi, psi' and psi'' in Pa.
namespace latcon::lattice
{

#include "lattice/bond_force.inc"

/// Uniaxial incompressible Mooney-Rivlin rod (theory.md, eqs. (L.2) and (L.3)), with a = 2 C1 and b = 2 C2 in Pa:
///   psi  = a (lam^2 / 2 + 1 / lam - 3/2) + b (lam + 1 / (2 lam^2) - 3/2)
///   psi' = a (lam - lam^-2) + b (1 - lam^-3)
/// With a negative constant the energy has no lower bound, psi -> a lam^2 / 2 in a long bond and b / (2 lam^2) in a
/// short one, and no stretch bounds the stiffness of the shorter bonds.
struct MooneyRivlinBond
{
  /// @throws std::invalid_argument unless a and b are non-negative, finite and not both 0
  MooneyRivlinBond(double a_, double b_) : a(a_), b(b_)
  {
    if (!(a >= 0. && b >= 0. && a + b > 0. && a + b < std::numeric_limits<double>::infinity()))
      throw std::invalid_argument("a Mooney-Rivlin bond needs constants a, b >= 0, one of them positive");
  }

  double a; ///< [Pa], >= 0
  double b; ///< [Pa], >= 0

  /// psi(lam) [Pa], energy per reference volume of the bond.
  double energy(double stretch) const
  {
    const double inverse = 1. / stretch;
    return a * (0.5 * stretch * stretch + inverse - 1.5) + b * (stretch + 0.5 * inverse * inverse - 1.5);
  }

  /// psi'(lam) [Pa], axial force per reference cross-section, tension positive.
  double force(double stretch) const { return force(stretch, 1. / stretch); }

  /// The same for a caller that has 1 / lam at hand; the hot loop does.
  double force(double stretch, double inverse) const { return mooney_rivlin_force(a, b, stretch, inverse); }

  /// psi''(lam) [Pa], axial tangent stiffness per reference cross-section.
  double stiffness(double stretch) const
  {
    const double inverse = 1. / stretch;
    const double inverse_cube = inverse * inverse * inverse;
    return a * (1. + 2. * inverse_cube) + 3. * b * inverse_cube * inverse;
  }

  /// Largest psi''(lam) [Pa] of all lam >= smallest_stretch, since psi''' <= 0 with a, b >= 0.
  double largest_stiffness(double smallest_stretch) const { return stiffness(smallest_stretch); }
};

/// Linear spring psi = (e / 2) (lam - 1)^2 with modulus e > 0 in Pa.
struct LinearBond
{
  /// @throws std::invalid_argument unless e is positive and finite
  explicit LinearBond(double modulus_) : modulus(modulus_)
  {
    if (!(modulus > 0. && modulus < std::numeric_limits<double>::infinity()))
      throw std::invalid_argument("a linear bond needs a positive modulus");
  }

  double modulus; ///< e [Pa], > 0

  /// psi(lam) [Pa].
  double energy(double stretch) const { return 0.5 * modulus * (stretch - 1.) * (stretch - 1.); }

  /// psi'(lam) [Pa].
  double force(double stretch) const { return linear_force(modulus, stretch); }

  /// The same; the linear law has no use for 1 / lam.
  double force(double stretch, double /*inverse*/) const { return force(stretch); }

  /// psi''(lam) [Pa].
  double stiffness(double /*stretch*/) const { return modulus; }

  /// The same, whatever the stretch.
  double largest_stiffness(double /*smallest_stretch*/) const { return modulus; }
};

/// The law of one shell of bonds. CustomBond takes any law; one that the hot loop is to compute for vectors of bonds is
/// a further alternative here, with a `force` in row_kernels.cc.
using BondLaw = std::variant<MooneyRivlinBond, LinearBond, CustomBond>;

/// psi [Pa].
inline double energy(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.energy(stretch); }, law);
}
/// psi' [Pa].
inline double force(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.force(stretch); }, law);
}
/// psi'' [Pa].
inline double stiffness(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.stiffness(stretch); }, law);
}
/// Largest psi'' [Pa] of all stretches from `smallest_stretch` [-] on that a bond gets to.
inline double largest_stiffness(const BondLaw &law, double smallest_stretch)
{
  return std::visit([smallest_stretch](const auto &l) { return l.largest_stiffness(smallest_stretch); }, law);
}

} // namespace latcon::lattice
