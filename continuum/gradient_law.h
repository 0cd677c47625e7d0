#pragma once

#include "continuum/material.h"

namespace latcon::continuum
{
/// Form B(F; G, Z) of a gradient law at a point and its derivatives up to an order; those beyond it are zero. The form
/// is linear in G and Z, so that derivatives by these are those of the double stress Q: Q(F, G) = dB/dZ.
struct GradientForm
{
  double value = 0.;          ///< B [Pa]
  dealii::Tensor<2, 2> by_F;  ///< [Pa]
  dealii::Tensor<3, 2> by_G;  ///< Q(F, Z) [Pa m], symmetric in J and K
  dealii::Tensor<3, 2> by_Z;  ///< Q(F, G) [Pa m], symmetric in J and K
  dealii::Tensor<4, 2> by_FF; ///< [Pa], index order [i][J][k][L]
  dealii::Tensor<5, 2> by_GF; ///< dQ(F, Z)_iJK/dF_lM [Pa m], index order [i][J][K][l][M]
  dealii::Tensor<5, 2> by_ZF; ///< dQ(F, G)_iJK/dF_lM [Pa m], index order [i][J][K][l][M]
  dealii::Tensor<6, 2> by_GZ; ///< dQ_iJK/dG_lMN [Pa m^2], symmetric in J and K and in M and N; independent of G and Z
};

/// Law of the energy that depends on the gradient of deformation, added to the energy of the local law:
///   W_g(F, G) = B(F; G, G) / 2    [Pa = J/m^3],        G_iJK = dF_iJ/dX_K = d2x_i/dX_J dX_K  [1/m]
/// with B(F; G, Z) symmetric and bilinear in G and Z, so that the energy vanishes with the gradient
/// (theory-continuum.md, eq. (C.20)). Laws are const and stateless. F as in Material; densities per reference volume.
///
/// A subclass implements B with its derivatives, from which energy and stresses follow. The discretisation uses B with
/// two different arguments where the normal derivative of the displacement jumps (eq. (C.28)). All functions throw
/// NonPhysicalState if the law depends on F and F is invalid (det F <= 0 or not finite).
class GradientLaw
{
public:
  using Gradient = dealii::Tensor<3, 2>; ///< index order [i][J][K], symmetric in J and K

  virtual ~GradientLaw() = default;

  /// Returns true if B = 0 for every F, G and Z. Such a law is ignored: no gradient energy, no face terms. A law that
  /// vanishes only for some F must return false.
  virtual bool is_zero() const { return false; }

  /// Returns B(F; G, Z) and its derivatives up to `order`.
  virtual GradientForm evaluate(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z,
                                Order order) const = 0;

  /// W_g [Pa].
  double energy(const dealii::Tensor<2, 2> &F, const Gradient &G) const
  {
    return 0.5 * evaluate(F, G, G, Order::value).value;
  }

  /// dW_g/dF_iJ [Pa]: contribution of the gradient energy to the first Piola stress.
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const
  {
    return 0.5 * evaluate(F, G, G, Order::first).by_F;
  }

  /// Double stress Q_iJK = dW_g/dG_iJK [Pa m], with Q : Z = B(F; G, Z) for every Z; symmetric in J and K.
  Gradient double_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const
  {
    return evaluate(F, G, G, Order::first).by_Z;
  }

  /// dQ_iJK/dG_lMN [Pa m^2], index order [i][J][K][l][M][N].
  dealii::Tensor<6, 2> double_stress_by_G(const dealii::Tensor<2, 2> &F) const
  {
    return evaluate(F, Gradient(), Gradient(), Order::second).by_GZ;
  }

  /// Returns the stiffness [Pa m^2] against a second derivative along the unit vector N in both directions: the sum
  /// over i of B(F; Z, Z) with Z = unit_jump(i, N N), an upper bound and at most twice that in any one direction.
  double stiffness_across(const dealii::Tensor<2, 2> &F, const dealii::Tensor<1, 2> &N) const;

  /// Returns e_i (x) NN, the second gradient of a unit jump of component i of the normal derivative.
  static Gradient unit_jump(unsigned int i, const dealii::Tensor<2, 2> &NN);

  /// Returns the largest stiffness [Pa m^2] against a second normal derivative at F = I: the largest eigenvalue of n_J
  /// n_K (dQ_iJK/dG_lMN) n_M n_N over all unit vectors n.
  double normal_stiffness() const;
};
} // namespace latcon::continuum
