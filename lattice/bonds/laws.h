#ifndef LATCON_LATTICE_BONDS_LAWS_H
#define LATCON_LATTICE_BONDS_LAWS_H

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "support/require.h"

/// @file
/// Bond laws: energy, force and stiffness as functions of the stretch alone. What a bond adds that depends on its past
/// is its memory (memories.h).
///
/// A bond of rest length l and cross-section A0 stores A0 l psi(lam), lam = |x_j - x_i| / l > 0 being its stretch, and
/// pulls with the axial force A0 psi'(lam), tension positive. A law gives psi, psi' and psi'' in Pa: its class its
/// constants, energy, stiffness and limits, its formula (last in this file) its force. `stiffens_when_short` is whether
/// short bonds may require divided time steps; not those of laws as stiff at any stretch.
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
    support::require(a >= 0. && b >= 0. && a + b > 0. && a + b < std::numeric_limits<double>::infinity(),
                     "a Mooney-Rivlin bond needs constants a, b >= 0, one of them positive");
  }

  double a; ///< [Pa], >= 0
  double b; ///< [Pa], >= 0

  static constexpr bool stiffens_when_short = true;

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
    support::require(modulus > 0. && modulus < std::numeric_limits<double>::infinity(),
                     "a linear bond needs a positive modulus");
  }

  double modulus; ///< e [Pa], > 0

  static constexpr bool stiffens_when_short = false;

  double energy(double stretch) const { return 0.5 * modulus * (stretch - 1.) * (stretch - 1.); } ///< psi(lam) [Pa]
  double stiffness(double /*stretch*/) const { return modulus; }                                  ///< psi''(lam) [Pa]
  double largest_stiffness(double /*smallest_stretch*/) const { return modulus; }                 ///< [Pa]
};

/// User-defined bond law: derive from it, and construct a Shell with a CustomBond of it.
///
/// The law gives psi and its derivatives as functions of the stretch lam [-] alone, as defined above. They must be
/// smooth for every lam > 0 that a bond may reach before it breaks, and the bond must be free of energy and force at
/// rest and stiff there: psi(1) = psi'(1) = 0, psi''(1) > 0.
///
/// Several threads call the functions at once, with any lam > 0, also beyond the stretch at which bonds break: they may
/// not change anything, nor throw. Where the law has no value they return NaN or infinity. That spreads to the sites of
/// the bond and from there through the sheet; State::position and energies() show it, relax() and the program's
/// commands stop at it.
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
  explicit CustomBond(std::shared_ptr<const CustomBondLaw> law) : law_(std::move(law))
  {
    support::require(law_ != nullptr, "a bond needs a law");
    const double stiffness = law_->stiffness(1.), round_off = 1e-12 * stiffness;
    support::require(stiffness > 0. && stiffness < std::numeric_limits<double>::infinity(),
                     "a bond needs a finite stiffness > 0 at rest, not " + std::to_string(stiffness) + " Pa");
    support::require(std::abs(law_->energy(1.)) <= round_off && std::abs(law_->force(1.)) <= round_off,
                     "a bond holds neither energy nor force at rest, not " + std::to_string(law_->energy(1.)) +
                       " and " + std::to_string(law_->force(1.)) + " Pa");
  }

  static constexpr bool stiffens_when_short = true;

  double energy(double stretch) const { return law_->energy(stretch); }       ///< psi(lam) [Pa]
  double stiffness(double stretch) const { return law_->stiffness(stretch); } ///< psi''(lam) [Pa]
  double largest_stiffness(double smallest_stretch) const { return law_->largest_stiffness(smallest_stretch); }

  const std::shared_ptr<const CustomBondLaw> &law() const { return law_; }

private:
  std::shared_ptr<const CustomBondLaw> law_;
};

/// Bond law of one shell.
using BondLaw = std::variant<MooneyRivlinBond, LinearBond, CustomBond>;

/// psi [Pa].
inline double energy(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.energy(stretch); }, law);
}
/// psi'' [Pa].
inline double stiffness(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.stiffness(stretch); }, law);
}
/// Largest psi'' [Pa] of all stretches from `smallest_stretch` [-] on that a bond reaches.
inline double largest_stiffness(const BondLaw &law, double smallest_stretch)
{
  return std::visit([smallest_stretch](const auto &l) { return l.largest_stiffness(smallest_stretch); }, law);
}
/// Returns whether short bonds may require divided time steps.
inline bool stiffens_when_short(const BondLaw &law)
{
  return std::visit([](const auto &l) { return l.stiffens_when_short; }, law);
}

} // namespace latcon::lattice

#endif
#ifdef LATCON_BOND_FORMULAS // see formulas.inc

// psi'(lam) [Pa], axial force per reference cross-section, tension positive. @param inverse 1 / lam
template <class Number>
inline Number force(const MooneyRivlinBond &law, Number stretch, Number inverse)
{
  const Number inverse_square = inverse * inverse;
  return law.a * (stretch - inverse_square) + law.b * (1. - inverse_square * inverse);
}
template <class Number>
inline Number force(const LinearBond &law, Number stretch, Number /*inverse*/)
{
  return law.modulus * (stretch - 1.);
}

#endif
