#pragma once

#include "continuum/gradient_law.h"
#include "continuum/material.h"

namespace latcon::continuum
{
/// What a sheet is made of: W(F) + W_g(F, Grad F), and the inertia that goes with them. The laws must outlive all that
/// is made with it.
struct Constitution
{
  Constitution(const Material &law) : local(&law) {}
  Constitution(const Material &law, const GradientLaw &gradient_law) : local(&law), gradient(&gradient_law) {}

  /// Whether there is a gradient energy: a gradient law that is not zero.
  bool has_gradient() const { return gradient != nullptr && !gradient->is_zero(); }

  /// W(F) + W_g(F, G) [J/m^3].
  double energy(const dealii::Tensor<2, 2> &F, const dealii::Tensor<3, 2> &G) const
  {
    return local->energy(F) + (has_gradient() ? gradient->energy(F, G) : 0.);
  }

  /// P_iJ = d(W + W_g)/dF_iJ [Pa].
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<3, 2> &G) const
  {
    dealii::Tensor<2, 2> P = local->first_piola_stress(F);
    if (has_gradient())
      P += gradient->first_piola_stress(F, G);
    return P;
  }

  /// Q_iJK = dW_g/dG_iJK [Pa m].
  dealii::Tensor<3, 2> double_stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<3, 2> &G) const
  {
    return has_gradient() ? gradient->double_stress(F, G) : dealii::Tensor<3, 2>();
  }

  const Material *local;
  const GradientLaw *gradient = nullptr; ///< none: the local theory

  /// gamma [-] of the interior penalty gamma p (p + 1) / h times the law's normal stiffness at F = I, which must be
  /// positive. Coercivity needs
  /// the penalty to outweigh the mean double traction on a face by an inverse estimate, which grows as p^2 / h and asks
  /// for about 0.3; the rest is margin for a law that stiffens under deformation and a mesh that is not uniform. Less
  /// than 2 makes quadratic elements reach their order on finer meshes only; more costs linear iterations.
  double penalty = 2.;
};
} // namespace latcon::continuum
