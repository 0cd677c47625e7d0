#pragma once

#include <cstddef>
#include <limits>
#include <memory>

#include "lattice/bonds/require.h"

/// @file
/// The laws that a bond may have (bond_law.h): its energy psi per reference volume and the derivatives psi', psi'' [Pa]
/// as functions of the stretch lam [-].
namespace latcon::lattice
{

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
    require(a >= 0. && b >= 0. && a + b > 0. && a + b < std::numeric_limits<double>::infinity(),
            "a Mooney-Rivlin bond needs constants a, b >= 0, one of them positive");
  }

  double a; ///< [Pa], >= 0
  double b; ///< [Pa], >= 0

  static constexpr bool stiffens_when_short = true; ///< whether short bonds may require divided steps

  /// psi(lam) [Pa], energy per reference volume of the bond.
  double energy(double stretch) const
  {
    const double inverse = 1. / stretch;
    return a * (0.5 * stretch * stretch + inverse - 1.5) + b * (stretch + 0.5 * inverse * inverse - 1.5);
  }

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
    require(modulus > 0. && modulus < std::numeric_limits<double>::infinity(),
            "a linear bond needs a positive modulus");
  }

  double modulus; ///< e [Pa], > 0

  static constexpr bool stiffens_when_short = false; ///< whether short bonds may require divided steps

  /// psi(lam) [Pa].
  double energy(double stretch) const { return 0.5 * modulus * (stretch - 1.) * (stretch - 1.); }

  /// psi''(lam) [Pa].
  double stiffness(double /*stretch*/) const { return modulus; }

  /// Constant for this law.
  double largest_stiffness(double /*smallest_stretch*/) const { return modulus; }
};

/// User-defined bond law: derive from it, and construct a Shell with a CustomBond of it.
///
/// The law gives psi and its derivatives as functions of the stretch lam [-] alone, as bond_law.h defines them. They
/// must be smooth for every lam > 0 that a bond may reach before it breaks, and the bond must be free of energy and
/// force at rest and stiff there: psi(1) = psi'(1) = 0, psi''(1) > 0.
///
/// Several threads call the functions at once, with any lam > 0, also beyond the stretch at which bonds break: they may
/// not change anything, nor throw. Where the law has no value they return NaN or infinity. That spreads to the sites of
/// the bond and from there through the sheet; State::x and energies() show it, relax() and the program's commands stop
/// at it.
class CustomBondLaw
{
public:
  virtual ~CustomBondLaw() = default;

  /// psi(lam) [Pa], energy per reference volume of the bond.
  virtual double energy(double stretch) const noexcept = 0;

  /// psi'(lam) [Pa], axial force per reference cross-section, tension positive. The loop over all bonds calls this.
  virtual double force(double stretch) const noexcept = 0;

  /// psi' [Pa] of n bonds, the same bits as force() gives for each. Overridden where this is faster for several bonds.
  virtual void forces(std::size_t n, const double *stretches, double *forces) const noexcept
  {
    for (std::size_t i = 0; i < n; ++i)
      forces[i] = force(stretches[i]);
  }

  /// psi''(lam) [Pa], axial tangent stiffness per reference cross-section.
  virtual double stiffness(double stretch) const noexcept = 0;

  /// A bound [Pa] on psi'' and on psi' / lam for every lam >= `smallest_stretch` [-] that an unbroken bond reaches;
  /// limits of the time step follow from it. `stiffness(smallest_stretch)` for a law that is stiffer the shorter the
  /// bond.
  virtual double largest_stiffness(double smallest_stretch) const noexcept = 0;
};

/// A bond with a user-defined law.
class CustomBond
{
public:
  /// @throws std::invalid_argument without a law, or for one that is not free of energy and force (to 1e-12 of its
  /// stiffness) or not stiff at rest
  explicit CustomBond(std::shared_ptr<const CustomBondLaw> law);

  static constexpr bool stiffens_when_short = true; ///< whether short bonds may require divided steps

  double energy(double stretch) const { return law_->energy(stretch); }       ///< psi(lam) [Pa]
  double stiffness(double stretch) const { return law_->stiffness(stretch); } ///< psi''(lam) [Pa]
  double largest_stiffness(double smallest_stretch) const { return law_->largest_stiffness(smallest_stretch); }

  /// psi'(lam) [Pa]; 0 for absent bonds, which have no length.
  double force(double stretch) const { return stretch > 0. ? law_->force(stretch) : 0.; }

  /// psi' [Pa] of n bonds, in place of their stretches, as force() gives it.
  void forces(std::size_t n, double *stretches) const
  {
    double present[max_bonds], of_law[max_bonds];
    for (std::size_t i = 0; i < n; ++i)
      present[i] = stretches[i] > 0. ? stretches[i] : 1.;
    law_->forces(n, present, of_law);
    for (std::size_t i = 0; i < n; ++i)
      stretches[i] = stretches[i] > 0. ? of_law[i] : 0.;
  }
  static constexpr std::size_t max_bonds = 8; ///< of one call of forces()

  const std::shared_ptr<const CustomBondLaw> &law() const { return law_; }

private:
  std::shared_ptr<const CustomBondLaw> law_;
};

} // namespace latcon::lattice
