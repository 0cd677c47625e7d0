#pragma once

#include "continuum/gradient_law.h"
#include "continuum/material.h"

namespace latcon::continuum
{
/// Constitutive model of a sheet: local law W(F), optional gradient law W_g(F, Grad F), and penalty of the gradient
/// law. The laws must outlive every object that uses this one.
struct Constitution
{
  Constitution(const Material &law) : local(&law) {}
  Constitution(const Material &law, const GradientLaw &gradient_law) : local(&law), gradient(&gradient_law) {}

  /// Returns true if there is a gradient law that is not identically zero.
  bool has_gradient() const { return gradient != nullptr && !gradient->is_zero(); }

  /// Returns W(F) + W_g(F, G) [J/m^3] at the reference position X [m] with its first derivatives.
  GradientResponse evaluate(const dealii::Point<2> &X, const dealii::Tensor<2, 2> &F,
                            const dealii::Tensor<3, 2> &G) const
  {
    GradientResponse sum = has_gradient() ? gradient->evaluate(F, G, Order::first) : GradientResponse();
    const Response W = local->at(X).evaluate(F, Order::first);
    sum.energy += W.energy;
    sum.first_piola += W.first_piola;
    return sum;
  }

  const Material *local;
  const GradientLaw *gradient = nullptr; ///< nullptr: local theory

  /// Factor gamma >= 0 [-] of the penalty gamma p (p + 1) / h times the normal stiffness of the gradient law at F = I
  /// on jumps of the normal derivative, eq. (C.28). The lifted gradient needs none to be stable; a small one keeps
  /// jumps from growing on coarse meshes where a law is soft in some directions. A larger gamma costs linear
  /// iterations.
  double penalty = 0.5;
};
} // namespace latcon::continuum
