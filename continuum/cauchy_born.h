#pragma once

#include "continuum/fibres.h"
#include "continuum/material.h"

#include <vector>

namespace latcon::continuum
{
/// Hyperelastic law of a network of fibres that all follow the deformation gradient (Cauchy-Born rule;
/// theory-continuum.md, eqs. (C.11) to (C.14)):
///   W(F) = sum over families of  c_k psi_k(l_k),   l_k = |F N_k|    [Pa]
/// Exact for a periodic network whose unit cell has one point. The law does not model the thickness.
class CauchyBorn : public Material
{
public:
  /// Creates the law from one or more families. Throws InvalidInput if there is no family, a direction is not a unit
  /// vector to 1e-12, a weight is not positive, or a potential has no positive stiffness at l = 1.
  explicit CauchyBorn(std::vector<FibreFamily> families);

  Response evaluate(const dealii::Tensor<2, 2> &F, Order order) const override;

  const std::vector<FibreFamily> &families() const { return families_; }

private:
  std::vector<FibreFamily> families_;
};
} // namespace latcon::continuum
