#pragma once

#include <memory>
#include <vector>

#include "lattice/bonds/custom_bond.h"
#include "lattice/bonds/stiffness_bound.h"
#include "support/expression.h"

namespace latcon::lattice
{

/// Bond law whose energy psi(lam) [Pa] is an expression. psi' and psi'' follow from it by the rules of differentiation.
///
/// Forces of several bonds are computed together, operation by operation. Integer powers from -64 to 64 are
/// products, so that laws of + - * /, sqrt and such powers have the same bits on all processors; other powers, exp and
/// log are those of the system's mathematical library.
class ExpressionLaw : public CustomBondLaw
{
public:
  /// @param psi energy per reference volume [Pa] as a function of the stretch, up to a constant
  /// @param longest largest stretch of an unbroken bond [-], > 1
  /// @throws InvalidBondLaw as check_law does for stretches from smallest_checked_stretch on
  /// @throws std::length_error if psi'' takes more than Expression::max_nodes operations
  ExpressionLaw(support::Expression psi, double longest);

  double energy(double stretch) const noexcept override;
  double force(double stretch) const noexcept override;
  double stiffness(double stretch) const noexcept override;
  void forces(std::size_t n, const double *stretches, double *forces) const noexcept override;
  double largest_stiffness(double smallest_stretch) const noexcept override;

  const support::Expression &psi() const { return psi_; } ///< as given

private:
  // Operations in an order in which they can be done. Operands are values of earlier ones, or constants.
  class Program
  {
  public:
    Program() = default;
    explicit Program(const support::Expression &function);
    // Values at n stretches, n being 1, 2, 4 or 8.
    template <std::size_t n>
    void run(const double *stretches, double *values) const;

  private:
    struct Step
    {
      support::Expression::Operation operation;
      double value;            // exponent
      std::size_t left, right; // constants first, then steps
    };
    std::vector<double> constants_; // each as often as there can be stretches
    std::vector<Step> steps_;
    std::size_t result_ = 0;
  };

  support::Expression psi_;
  double at_rest_ = 0.; // [Pa], psi(1) as given
  Program energy_, force_, stiffness_;
  std::unique_ptr<const StiffnessBound> bound_;
};

} // namespace latcon::lattice
