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

double IsotropicGradient::form(const Tensor<2, 2> &, const Gradient &G, const Gradient &Z) const
{
  return modulus_ * scalar_product(G, Z);
}

Tensor<2, 2> IsotropicGradient::form_by_F(const Tensor<2, 2> &, const Gradient &, const Gradient &) const
{
  return {};
}

Tensor<4, 2> IsotropicGradient::form_by_FF(const Tensor<2, 2> &, const Gradient &, const Gradient &) const
{
  return {};
}

GradientLaw::Gradient IsotropicGradient::double_stress(const Tensor<2, 2> &, const Gradient &G) const
{
  return modulus_ * G;
}

Tensor<5, 2> IsotropicGradient::double_stress_by_F(const Tensor<2, 2> &, const Gradient &) const
{
  return {};
}

Tensor<6, 2> IsotropicGradient::double_stress_by_G(const Tensor<2, 2> &) const
{
  Tensor<6, 2> C;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
      {
        // Identity on gradients that are symmetric in their last two indices.
        C[i][J][K][i][J][K] += 0.5 * modulus_;
        C[i][J][K][i][K][J] += 0.5 * modulus_;
      }
  return C;
}
} // namespace latcon::continuum
