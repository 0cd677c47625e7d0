#pragma once

#include "continuum/point_integrand.h"

namespace latcon::continuum
{
/// Strain measure of a family of fibres with the reference direction N: their stretch l = |f|, f = F N, or one of the
/// two components of its gradient, e = n . a with n = f/l and a_i = G_iJK N_J M_K, M normal to N or N itself
/// (theory-continuum.md, eq. (C.61)).
struct StrainMeasure
{
  bool is_gradient;
  double weight; ///< of its share in an energy or a power: c [-] for the stretch, c times a squared length [m^2] for e
  /// Factors of the derivatives of u_i: of the first ones in f_i - N_i, which are N, and of the second ones in a_i.
  ComponentDerivatives factors;
};

/// Returns the stretch as a measure. @param N unit vector
StrainMeasure stretch_measure(const dealii::Tensor<1, 2> &N, double weight);

/// Returns l_d^2 - l^2/12 [m^2], 0 where that is round-off. A law with the micro-inertia length l_d and fibres of
/// length l is positive unless it is negative.
double squared_length_along(double length, double gradient_length);

/// Returns the components of the gradient across and along the fibre, with the weights c l_d^2 and c (l_d^2 - l^2/12).
/// Throws InvalidInput if a length is not positive and finite, or the second weight negative.
/// @param length l [m], undeformed @param gradient_length l_d [m]
std::array<StrainMeasure, 2> gradient_measures(const dealii::Tensor<1, 2> &N, double weight, double length,
                                               double gradient_length);

/// Strain of a fibre at a point as a function of f and a, with its derivatives, and the forces that do work on it.
class FibreStrain
{
public:
  /// Derivatives by f, in row 0, and by a, in row 1, of a scalar; or rates of f and a.
  using Pair = dealii::Tensor<2, 2>;

  FibreStrain(const StrainMeasure &measure, const FieldDerivatives &u);

  double value() const { return value_; } ///< [-], of a gradient [1/m]
  const Pair &first() const { return first_; }

  /// Returns the rate for the velocity v.
  double rate(const FieldDerivatives &v) const { return scalar_product(first_, rates(v)); }

  /// Returns the derivatives of rate() by f and a at constant v.
  Pair rate_by_state(const FieldDerivatives &v) const;

  /// Adds a force q that is conjugate to the strain to the first derivatives of a density.
  void add_force(double q, PointIntegrand &density) const;

  /// Adds its derivative by u to the second ones. @param by_state derivatives of q by f and a
  void add_stiffness(double q, const Pair &by_state, PointIntegrand &density) const;

private:
  Pair rates(const FieldDerivatives &v) const;
  unsigned int n_factors() const { return measure_.is_gradient ? n_derivatives : n_first; }

  const StrainMeasure &measure_;
  double value_;
  Pair first_;
  dealii::Tensor<2, 2> by_ff_, by_fa_; // second derivatives; that by a twice is zero
};
} // namespace latcon::continuum
