#pragma once

#include <deal.II/base/tensor.h>

namespace latcon::continuum
{
/// The energy that a sheet has from the gradient of its deformation, added to that of the local law:
///   W_g(F, G) = B(F; G, G) / 2    [Pa = J/m^3],        G_iJK = dF_iJ/dX_K = d2x_i/dX_J dX_K  [1/m]
/// with B(F; G, Z) symmetric and bilinear in G and Z, so that it vanishes with the gradient and leaves the local law
/// (theory-continuum.md, eq. (C.20)). Const and stateless. F as in Material; densities per reference volume.
///
/// A law states B and its derivatives; energy and stresses follow from it. B with two different arguments is what the
/// discretisation needs where the normal derivative of displacement jumps (eq. (C.28)). All functions throw
/// NonPhysicalState when F is not a deformation (det F <= 0, not finite) and the law depends on F.
class GradientLaw
{
public:
  using Gradient = dealii::Tensor<3, 2>; ///< index order [i][J][K], symmetric in J and K

  virtual ~GradientLaw() = default;

  /// Returns whether B = 0 for every F, G and Z. Such a law is treated as absent: no gradient energy and no face terms.
  /// A law that vanishes only for some F must return false.
  virtual bool is_zero() const { return false; }

  /// B(F; G, Z) [Pa].
  virtual double form(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const = 0;

  /// dB(F; G, Z)/dF_iJ [Pa].
  virtual dealii::Tensor<2, 2> form_by_F(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const = 0;

  /// d2B(F; G, Z)/dF_iJ dF_kL [Pa], index order [i][J][k][L].
  virtual dealii::Tensor<4, 2> form_by_FF(const dealii::Tensor<2, 2> &F, const Gradient &G,
                                          const Gradient &Z) const = 0;

  /// Double stress Q_iJK = dW_g/dG_iJK [Pa m], with Q : Z = B(F; G, Z) for every Z; symmetric in J and K.
  virtual Gradient double_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const = 0;

  /// dQ_iJK/dF_lM [Pa m], index order [i][J][K][l][M].
  virtual dealii::Tensor<5, 2> double_stress_by_F(const dealii::Tensor<2, 2> &F, const Gradient &G) const = 0;

  /// dQ_iJK/dG_lMN [Pa m^2], index order [i][J][K][l][M][N], symmetric in J and K and in M and N; it does
  /// not depend on G.
  virtual dealii::Tensor<6, 2> double_stress_by_G(const dealii::Tensor<2, 2> &F) const = 0;

  /// W_g [Pa].
  double energy(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

  /// dW_g/dF_iJ [Pa]: the part of the first Piola stress that the gradient brings.
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

  /// d2W_g/dF_iJ dF_kL [Pa].
  dealii::Tensor<4, 2> tangent(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

  /// Largest stiffness against a second normal derivative at F = I: the largest eigenvalue over all unit vectors n
  /// of n_J n_K (dQ_iJK/dG_lMN) n_M n_N [Pa m^2].
  double normal_stiffness() const;
};
} // namespace latcon::continuum
