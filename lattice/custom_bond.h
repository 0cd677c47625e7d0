#pragma once

#include <memory>

namespace latcon::lattice
{

/// A bond law from outside of latcon: derive from it, and give a Shell a CustomBond of it.
///
/// The law gives psi and its derivatives as functions of the stretch lam [-] alone, as bond_law.h says. They must be
/// smooth for every lam > 0 that a bond may get to before it breaks, and the bond must be free of energy and force at
/// rest and stiff there: psi(1) = psi'(1) = 0, psi''(1) > 0.
///
/// The functions are called by several threads at once, with any lam > 0, also beyond the stretch at which bonds break:
/// they may not change anything, nor throw. Where the law has no value they return NaN or infinity. That spreads to the
/// sites of the bond and from there through the sheet; State::x and energies() show it, relax() and the program's
/// commands stop at it.
class CustomBondLaw
{
public:
  virtual ~CustomBondLaw() = default;

  /// psi(lam) [Pa], energy per reference volume of the bond.
  virtual double energy(double stretch) const noexcept = 0;

  /// psi'(lam) [Pa], axial force per reference cross-section, tension positive. The loop over all bonds calls this.
  virtual double force(double stretch) const noexcept = 0;

  /// psi''(lam) [Pa], axial tangent stiffness per reference cross-section.
  virtual double stiffness(double stretch) const noexcept = 0;

  /// A bound [Pa] on psi'' and on psi' / lam for every lam >= `smallest_stretch` [-] that an unbroken bond gets to;
  /// limits of the time step follow from it. `stiffness(smallest_stretch)` for a law that is stiffer the shorter the
  /// bond.
  virtual double largest_stiffness(double smallest_stretch) const noexcept = 0;
};

/// A bond with a law from outside.
class CustomBond
{
public:
  /// @throws std::invalid_argument without a law, or for one that is not free of energy and force (to 1e-12 of its
  /// stiffness) or not stiff at rest
  explicit CustomBond(std::shared_ptr<const CustomBondLaw> law);

  double energy(double stretch) const { return law_->energy(stretch); }       ///< psi(lam) [Pa]
  double force(double stretch) const { return law_->force(stretch); }         ///< psi'(lam) [Pa]
  double stiffness(double stretch) const { return law_->stiffness(stretch); } ///< psi''(lam) [Pa]
  double largest_stiffness(double smallest_stretch) const { return law_->largest_stiffness(smallest_stretch); }

  /// The same for the loop over all bonds, in which absent bonds have no length: 0 there.
  double force(double stretch, double /*inverse*/) const { return stretch > 0. ? law_->force(stretch) : 0.; }

private:
  std::shared_ptr<const CustomBondLaw> law_;
};

} // namespace latcon::lattice
