#pragma once

#include "continuum/fibres.h"
#include "continuum/gradient_law.h"

#include <vector>

namespace latcon::continuum
{
/// Family of bonds with one reference direction and one length.
struct BondFamily
{
  FibreFamily fibre;
  double length; ///< l [m] > 0, undeformed
};

/// Checks a family. Throws InvalidInput unless the fibre is valid and the length is positive and finite.
void check(const BondFamily &family);

/// Gradient law of a network of bonds, derived from the dispersion of long lattice waves to fourth order; the
/// micro-inertia length l_d makes it positive (theory-continuum.md, eqs. (C.22) to (C.26)):
///   W_g = (1/2) sum over families of c_k [ l_d^2 h_k(G N T, G N T) + (l_d^2 - l_k^2/12) h_k(G N N, G N N) ]
/// where h_k(a, b) = a_i b_j d2psi_k(|f|)/df_i df_j at f = F N, T is normal to N, (G N T)_i = G_iJK N_J T_K. Objective;
/// of hexagonal symmetry for a triangular network; positive where the bonds are in tension.
class LatticeGradient : public GradientLaw
{
public:
  /// Creates the law from `families`, with weights as in CauchyBorn, and `length` l_d [m]. Throws InvalidInput if a
  /// family is not valid, or if l_d^2 < l_k^2/12 for a family, which would make the energy indefinite.
  LatticeGradient(const std::vector<BondFamily> &families, double length);

  /// Stretch [-] above which a bond has its full transverse stiffness psi'/l. The transverse stiffness is zero at and
  /// below stretch 1; in between, h is twice continuously differentiable (theory-continuum.md, eq. (C.27)).
  static constexpr double full_stretch = 1.02;

  /// Returns the smallest l_d [m] for which the energy is positive: the longest bond over sqrt(12).
  static double smallest_length(const std::vector<BondFamily> &families);

  GradientResponse evaluate(const dealii::Tensor<2, 2> &F, const Gradient &G, Order order) const override;

private:
  // A family contributes two terms (1/2) c h(a, a) with a_i = G_iJK S_JK, which differ in S and its factor.
  struct Family
  {
    FibreFamily fibre;
    dealii::Tensor<2, 2> selector[2]; // S_JK [-]: N T symmetrised, and N N
    double factor[2];                 // weight times squared length [m^2]
  };

  std::vector<Family> families_;
};
} // namespace latcon::continuum
