#pragma once

#include "continuum/fibres.h"
#include "continuum/gradient_law.h"

#include <vector>

namespace latcon::continuum
{
/// Fibres of one direction that are not endless threads but bonds of one length.
struct BondFamily
{
  FibreFamily fibre;
  double length; ///< l [m] > 0, undeformed
};

/// Throws InvalidMaterial, unless the fibre is valid and the length positive and finite.
void check(const BondFamily &family);

/// The gradient energy that gives a network of bonds its long waves to fourth order, made positive by micro-inertia of
/// the length l_d (theory-continuum.md, eqs. (C.22) to (C.26)):
///   W_g = (1/2) sum over families of c_k [ l_d^2 h_k(G N T, G N T) + (l_d^2 - l_k^2/12) h_k(G N N, G N N) ]
/// where h_k(a, b) = a_i b_j d2psi_k(|f|)/df_i df_j at f = F N, T is normal to N, (G N T)_i = G_iJK N_J T_K. Objective;
/// hexagonal for a triangular network; positive wherever the bonds are in tension.
class LatticeGradient : public GradientLaw
{
public:
  /// `families` weighted as those of CauchyBorn; `length` l_d [m]. Throws InvalidMaterial if a family is not valid, a
  /// bond has no positive length, or l_d^2 < l_k^2/12 for one of them: the energy would not be positive.
  LatticeGradient(const std::vector<BondFamily> &families, double length);

  /// Stretch [-] from which on a bond has all of its stiffness across itself, psi'/l; at stretch 1 and below it has
  /// none, and h goes over with two continuous derivatives (theory-continuum.md, eq. (C.27)).
  static constexpr double full_stretch = 1.02;

  /// The shortest l_d [m] for which the energy is positive: the longest bond over sqrt(12).
  static double smallest_length(const std::vector<BondFamily> &families);

  double form(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const override;
  dealii::Tensor<2, 2> form_by_F(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const override;
  dealii::Tensor<4, 2> form_by_FF(const dealii::Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const override;
  Gradient double_stress(const dealii::Tensor<2, 2> &F, const Gradient &G) const override;
  dealii::Tensor<5, 2> double_stress_by_F(const dealii::Tensor<2, 2> &F, const Gradient &G) const override;
  dealii::Tensor<6, 2> double_stress_by_G(const dealii::Tensor<2, 2> &F) const override;

private:
  // A term (1/2) c h(a, a) with a_i = G_iJK S_JK. A family has two, which differ in S and its factor.
  struct Family
  {
    FibreFamily fibre;
    dealii::Tensor<2, 2> selector[2]; // S_JK [-]: N T symmetrised, and N N
    double factor[2];                 // weight times squared length [m^2]
  };

  std::vector<Family> families_;
};
} // namespace latcon::continuum
