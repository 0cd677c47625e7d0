#pragma once

#include "continuum/point_integrand.h"
#include "continuum/viscosity.h"

#include <vector>

namespace latcon::continuum
{
/// Gradient part of the viscosity of a network of dashpots, each of which resists the rate of the gradient of its own
/// stretch. It multiplies the viscous forces of long lattice waves by 1 + l_d^2 k^2 with the micro-inertia length l_d,
/// as LatticeGradient does the elastic ones (theory-continuum.md, eqs. (C.60) to (C.63)):
///   R_g = (1/2) sum over dashpots of c_k eta_k [ l_d^2 (d/dt dl_k/dT)^2 + (l_d^2 - l_k^2/12) (d/dt dl_k/dN)^2 ]
/// with the stretch l_k = |F N|, whose gradient is n . (G N), and T normal to N. Objective, never negative.
///
/// Densities are those of the dissipated power 2 R_g [W/m^3] as `value`, of R_g by the derivatives of v as `first`, and
/// of those by u, with dv/du = `rate_by_displacement` [1/s], as `second`, which is not symmetric where the sheet moves.
class GradientViscosity
{
public:
  /// Creates the law from `dashpots`, whose lengths l_k are needed, and `length` l_d [m]. Throws InvalidMaterial if a
  /// dashpot is not valid or has no length, or if l_d^2 < l_k^2/12 for one of them, which would make R_g indefinite.
  GradientViscosity(const std::vector<FibreDashpot> &dashpots, double length);

  /// Adds the density at a point, from the derivatives of u [m] and v [m/s], whose second ones are those of the lifted
  /// gradients, eq. (C.63).
  void add_density(const FieldDerivatives &u, const FieldDerivatives &v, Order order, double rate_by_displacement,
                   PointIntegrand &density) const;

  /// Returns the dissipated power [W/m^3] in the state F, G = Grad F [1/m] with the rates Fdot [1/s] and Grad Fdot.
  double dissipation(const dealii::Tensor<2, 2> &F, const dealii::Tensor<3, 2> &G, const dealii::Tensor<2, 2> &Fdot,
                     const dealii::Tensor<3, 2> &Gdot) const;

private:
  // A dashpot contributes two terms (1/2) factor (d/dt n_i G_iJK S_JK)^2.
  struct Term
  {
    double factor;            // [Pa s m^2]
    ComponentDerivatives row; // G_iJK S_JK as a sum over the derivatives of component i
  };
  struct Family
  {
    dealii::Tensor<1, 2> direction;
    Term terms[2];
  };

  std::vector<Family> families_;
};
} // namespace latcon::continuum
