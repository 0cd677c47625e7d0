#pragma once

#include "continuum/gradient_law.h"

namespace latcon::continuum
{
/// Isotropic gradient law W_g = (c_g/2) |Grad F|^2 with one constant c_g = mu l_s^2 (theory-continuum.md, eq. (C.21)):
/// objective and positive. It stiffens short waves, which then travel faster than long ones.
class IsotropicGradient : public GradientLaw
{
public:
  /// Creates the law from `shear_modulus` mu [Pa] > 0 and `length` l_s [m] >= 0. Throws InvalidInput if a value is
  /// out of range.
  IsotropicGradient(double shear_modulus, double length);

  bool is_zero() const override { return modulus_ == 0.; }
  GradientResponse evaluate(const dealii::Tensor<2, 2> &F, const Gradient &G, Order order) const override;

  double modulus() const { return modulus_; } ///< c_g [Pa m^2]

private:
  double modulus_;
};
} // namespace latcon::continuum
