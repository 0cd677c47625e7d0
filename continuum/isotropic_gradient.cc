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
    throw InvalidMaterial("an isotropic gradient energy needs a shear modulus > 0 and a length >= 0, both finite");
}

GradientForm IsotropicGradient::evaluate(const Tensor<2, 2> &, const Gradient &G, const Gradient &Z,
                                         const Order order) const
{
  GradientForm B;
  B.value = modulus_ * scalar_product(G, Z);
  if (order == Order::value)
    return B;
  B.by_G = modulus_ * Z;
  B.by_Z = modulus_ * G;
  for (unsigned int i = 0; i < 2 && order == Order::second; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
      {
        // Identity on gradients that are symmetric in their last two indices.
        B.by_GZ[i][J][K][i][J][K] += 0.5 * modulus_;
        B.by_GZ[i][J][K][i][K][J] += 0.5 * modulus_;
      }
  return B;
}
} // namespace latcon::continuum
