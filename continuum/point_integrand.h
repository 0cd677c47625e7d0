#pragma once

#include "continuum/gradient_law.h"
#include "continuum/material.h"

#include <array>

namespace latcon::continuum
{
/// Number of derivatives of a scalar field at a point by reference position: f_,1 f_,2 f_,11 f_,22 f_,12. Both
/// components of the displacement have the same scalar shape functions, so all kernels work on these five derivatives.
constexpr unsigned int n_derivatives = 5;
constexpr unsigned int n_first = 2;                             ///< number of first derivatives
using ComponentDerivatives = std::array<double, n_derivatives>; ///< of one component
using FieldDerivatives = std::array<ComponentDerivatives, 2>;   ///< one for each component

/// Density at a point as a function of the derivatives of u, with its first and second partial derivatives.
struct PointIntegrand
{
  double value = 0.;
  double first[2][n_derivatives];                    ///< [component][derivative]
  double second[2][2][n_derivatives][n_derivatives]; ///< [component][component'][derivative][derivative']
};

/// Sets the density and its derivatives up to `order` to zero.
void clear(PointIntegrand &density, Order order);

/// Returns F_iJ = delta_iJ + u_i,J of a displacement.
dealii::Tensor<2, 2> deformation_gradient(const FieldDerivatives &u);

/// Returns the derivatives of the displacement [-], [1/m] with the deformation gradient F_iJ [-] and its gradient G_iJK
/// [1/m], symmetric in J and K.
FieldDerivatives field_derivatives(const dealii::Tensor<2, 2> &F,
                                   const dealii::Tensor<3, 2> &G = dealii::Tensor<3, 2>());

/// Adds W(F) [J/m^3], eq. (C.28).
void add_energy(const Material &law, const FieldDerivatives &u, Order order, PointIntegrand &density);

/// Adds W_g(F, G) [J/m^3], eq. (C.28), where the second derivatives of `u` are those of the lifted gradient.
void add_energy(const GradientLaw &law, const FieldDerivatives &u, Order order, PointIntegrand &density);
} // namespace latcon::continuum
