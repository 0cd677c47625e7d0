#pragma once

#include "continuum/material.h"

namespace latcon::continuum
{
/// Energy W_g of a gradient law at a point and its derivatives by F and G up to an order; those beyond it are zero.
/// Third and higher tensors are symmetric in the two indices of each G.
struct GradientResponse : Response
{
  dealii::Tensor<3, 2> double_stress;      ///< Q_iJK = dW_g/dG_iJK [Pa m]
  dealii::Tensor<5, 2> double_stress_by_F; ///< dQ_iJK/dF_lM [Pa m], index order [i][J][K][l][M]
  dealii::Tensor<6, 2> double_stress_by_G; ///< dQ_iJK/dG_lMN [Pa m^2], index order [i][J][K][l][M][N]
};

/// Law of the energy W_g(F, G) [Pa = J/m^3] that depends on the gradient of deformation, added to the energy of the
/// local law (theory-continuum.md, eq. (C.20)):
///   G_iJK = dF_iJ/dX_K = d2x_i/dX_J dX_K  [1/m]
/// W_g vanishes with G and is never negative; the discretisation is as stable as the law is (eq. (C.28)). Laws are
/// const and stateless. F as in Material; densities per reference volume. All functions throw NonPhysicalState if the
/// law depends on F and F is invalid (det F <= 0 or not finite).
class GradientLaw
{
public:
  using Gradient = dealii::Tensor<3, 2>; ///< index order [i][J][K], symmetric in J and K

  virtual ~GradientLaw() = default;

  /// Returns true if W_g = 0 for every F and G. Such a law is ignored. A law that vanishes only for some F must return
  /// false.
  virtual bool is_zero() const { return false; }

  /// Returns the energy and its derivatives up to `order`.
  virtual GradientResponse evaluate(const dealii::Tensor<2, 2> &F, const Gradient &G, Order order) const = 0;

  double energy(const dealii::Tensor<2, 2> &F, const Gradient &G) const { return evaluate(F, G, Order::value).energy; }

  /// Returns dQ_iJK/dG_lMN [Pa m^2] at G = 0, index order [i][J][K][l][M][N].
  dealii::Tensor<6, 2> double_stress_by_G(const dealii::Tensor<2, 2> &F) const
  {
    return evaluate(F, Gradient(), Order::second).double_stress_by_G;
  }

  /// Returns the largest stiffness [Pa m^2] against a second normal derivative at F = I: the largest eigenvalue of n_J
  /// n_K (dQ_iJK/dG_lMN) n_M n_N over all unit vectors n.
  double normal_stiffness() const;
};
} // namespace latcon::continuum
