#pragma once

#include "continuum/fibre_strain.h"

#include <deal.II/base/point.h>

#include <memory>
#include <vector>

namespace latcon::continuum
{
/// Viscous law of a sheet: half of a dissipated power R [W/m^3] that is quadratic in the rate of deformation and adds
/// the stress dR/dFdot to the elastic one. Laws are const and stateless. Densities as in Material.
class Viscosity
{
public:
  virtual ~Viscosity() = default;

  /// Returns the law at a reference position X [m], as Material::at(). Its gradient part is that of this law.
  virtual const Viscosity &at(const dealii::Point<2> & /*X*/) const { return *this; }

  /// Adds the density at a point with the displacement u [m] and the velocity v [m/s]: as `value` the dissipated power
  /// 2 R, as `first` the derivatives of R by those of v, and as `second` those of `first` by the derivatives of u with
  /// dv/du = `rate_by_displacement` [1/s], which are not symmetric where the sheet moves. Objective: nothing for v = W
  /// x with W antisymmetric. Throws NonPhysicalState if det F <= 0 or not finite.
  virtual void add_density(const FieldDerivatives &u, const FieldDerivatives &v, Order order,
                           double rate_by_displacement, PointIntegrand &density) const = 0;

  /// Returns the part that depends on the second derivatives of u and v, those of the lifted gradients
  /// (theory-continuum.md, eq. (C.63)); nullptr: none. It requires a sheet with a gradient law.
  virtual const Viscosity *gradient() const { return nullptr; }
};

/// Family of dashpots with one reference direction.
struct FibreDashpot
{
  dealii::Tensor<1, 2> direction; ///< unit vector N_J [-], reference configuration
  double weight;                  ///< c [-] > 0, as in FibreFamily
  double viscosity;               ///< eta [Pa s] >= 0
  double length = 0.;             ///< l [m] > 0, undeformed; needed for the gradient part alone
};

/// Kelvin-Voigt damping of a network of fibres, each of which resists the rate of its own stretch l_k = |F N_k|
/// (theory-continuum.md, eqs. (C.41), (C.42)):
///   R = (1/2) sum over dashpots of c_k eta_k (dl_k/dt)^2
/// With c = A0 l/V it models the dashpots of a lattice of bonds. The gradient part resists the rate of the gradient of
/// the stretch along N and its normal T. It multiplies the viscous forces of long lattice waves by 1 + l_d^2 k^2 with
/// the micro-inertia length l_d, as LatticeGradient does the elastic ones (eqs. (C.60) to (C.63)):
///   R_g = (1/2) sum over dashpots of c_k eta_k [ l_d^2 (d/dt dl_k/dT)^2 + (l_d^2 - l_k^2/12) (d/dt dl_k/dN)^2 ]
class FibreViscosity : public Viscosity
{
public:
  /// Creates the law, with the gradient part of the micro-inertia length `gradient_length` l_d [m] unless that is 0.
  /// Throws InvalidInput if there is no dashpot, a direction is not a unit vector to 1e-12, a weight not positive or
  /// a viscosity negative, or any not finite, and as gradient_measures() does.
  explicit FibreViscosity(std::vector<FibreDashpot> dashpots, double gradient_length = 0.);

  void add_density(const FieldDerivatives &u, const FieldDerivatives &v, Order order, double rate_by_displacement,
                   PointIntegrand &density) const override;
  const Viscosity *gradient() const override { return gradient_.get(); }

  const std::vector<FibreDashpot> &dashpots() const { return dashpots_; }

private:
  std::vector<FibreDashpot> dashpots_;
  std::vector<StrainMeasure> strains_; // with weights times viscosities
  std::shared_ptr<const FibreViscosity> gradient_;
};
} // namespace latcon::continuum
