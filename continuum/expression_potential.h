#pragma once

#include "continuum/fibres.h"
#include "support/expression.h"

namespace latcon::continuum
{
/// Potential psi(l) [Pa] given by an expression, up to a constant; psi(1) = 0 is enforced. Its derivatives are computed
/// by automatic differentiation, operation by operation.
class ExpressionPotential : public CustomPotentialLaw
{
public:
  explicit ExpressionPotential(support::Expression psi);

  PotentialDerivatives derivatives(double l) const override;

private:
  support::Expression psi_;
  double at_rest_ = 0.; // psi(1) as given
};
} // namespace latcon::continuum
