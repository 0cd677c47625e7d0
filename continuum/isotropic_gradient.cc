#include "continuum/isotropic_gradient.h"

#include "continuum/errors.h"

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
IsotropicGradient::IsotropicGradient(const double shear_modulus, const double length)
  : modulus_(shear_modulus * length * length)
{
  if (!(shear_modulus > 0. && length >= 0. && std::isfinite(modulus_)))
    throw InvalidInput("an isotropic gradient energy needs a shear modulus > 0 and a length >= 0, both finite");
}

GradientResponse IsotropicGradient::evaluate(const Tensor<2, 2> &, const Gradient &G, const Order order) const
{
  GradientResponse W;
  W.energy = 0.5 * modulus_ * scalar_product(G, G);
  if (order == Order::value)
    return W;
  W.double_stress = modulus_ * G;
  for (unsigned int i = 0; i < 2 && order == Order::second; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
      {
        // Identity on gradients that are symmetric in their last two indices.
        W.double_stress_by_G[i][J][K][i][J][K] += 0.5 * modulus_;
        W.double_stress_by_G[i][J][K][i][K][J] += 0.5 * modulus_;
      }
  return W;
}
} // namespace latcon::continuum
