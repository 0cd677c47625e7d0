#pragma once

#include <deal.II/base/tensor.h>

namespace latcon::continuum
{
/// Law of the energy that depends on the gradient of deformation, added to the energy of the local law:
///   W_g(F, G) = B(F; G, G) / 2    [Pa = J/m^3],        G_iJK = dF_iJ/dX_K = d2x_i/dX_J dX_K  [1/m]
/// with B(F; G, Z) symmetric and bilinear in G and Z, so that the energy vanishes with the gradient
/// (theory-continuum.md, eq. (C.20)). Laws are const and stateless. F as in Material; densities per reference volume.
///
/// A subclass implements B and its derivatives, from which energy and stresses follow. The discretisation uses B with
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

  /// dQ_iJK/dG_lMN [Pa m^2], index order [i][J][K][l][M][N], symmetric in J and K and in M and N; independent of G.
  virtual dealii::Tensor<6, 2> double_stress_by_G(const dealii::Tensor<2, 2> &F) const = 0;

  /// W_g [Pa].
  double energy(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

  /// dW_g/dF_iJ [Pa]: contribution of the gradient energy to the first Piola stress.
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

  /// d2W_g/dF_iJ dF_kL [Pa].
  dealii::Tensor<4, 2> tangent(const dealii::Tensor<2, 2> &F, const Gradient &G) const;

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
