#pragma once

#include <array>

#include "lattice/bonds/law_check.h"
#include "support/expression.h"

namespace latcon::lattice
{

/// Bond law whose energy psi(lam) [Pa] is an expression. psi' and psi'' follow from it by automatic differentiation.
///
/// Forces of several bonds are computed together, operation by operation. Integer powers from -64 to 64 are
/// products, so that laws of + - * /, sqrt and such powers have the same bits on all processors; other powers, exp and
/// log are those of the system's mathematical library.
class ExpressionLaw : public CheckedLaw
{
public:
  /// @param psi energy per reference volume [Pa] as a function of the stretch, up to a constant
  /// @param longest largest stretch of an unbroken bond [-], > 1
  /// @throws InvalidBondLaw as check_law does for stretches from smallest_checked_stretch on
  ExpressionLaw(support::Expression psi, double longest);

  double energy(double stretch) const noexcept override { return derivatives(stretch)[0]; }
  double force(double stretch) const noexcept override;
  double stiffness(double stretch) const noexcept override { return derivatives(stretch)[2]; }
  void forces(std::size_t n, const double *stretches, double *forces) const noexcept override;

  const support::Expression &psi() const { return psi_; } ///< as given

private:
  /// psi and its first two derivatives [Pa], with psi(1) = 0.
  std::array<double, 3> derivatives(double stretch) const noexcept;

  support::Expression psi_;
  double at_rest_ = 0.; // [Pa], psi(1) as given
};

} // namespace latcon::lattice
