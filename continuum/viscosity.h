#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <vector>

namespace latcon::continuum
{
class GradientViscosity;

/// Viscous law of a sheet: a stress that depends on the rate of deformation, added to the elastic stress. Laws are
/// const and stateless. F and densities as in Material; Fdot_iJ = dv_i/dX_J [1/s]. All functions throw NonPhysicalState
/// if F is invalid (det F <= 0 or not finite).
class Viscosity
{
public:
  virtual ~Viscosity() = default;

  /// Returns the law at a reference position X [m], as Material::at(). Its gradient part is that of this law.
  virtual const Viscosity &at(const dealii::Point<2> & /*X*/) const { return *this; }

  /// First Piola stress P_iJ [Pa]. Objective: zero for Fdot = W F with W antisymmetric.
  virtual dealii::Tensor<2, 2> stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// dP_iJ/dF_kL [Pa], index order [i][J][k][L]. Not major symmetric.
  virtual dealii::Tensor<4, 2> stress_by_F(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// dP_iJ/dFdot_kL [Pa s], index order [i][J][k][L].
  virtual dealii::Tensor<4, 2> stress_by_rate(const dealii::Tensor<2, 2> &F,
                                              const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// Returns the part that depends on the gradients of F and Fdot; nullptr: none. It requires a sheet with a gradient
  /// law.
  virtual const GradientViscosity *gradient() const { return nullptr; }

  /// Returns the dissipated power P : Fdot >= 0 [W/m^3].
  double dissipation(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const;
};

/// Family of dashpots with one reference direction.
struct FibreDashpot
{
  dealii::Tensor<1, 2> direction; ///< unit vector N_J [-], reference configuration
  double weight;                  ///< c [-] > 0, as in FibreFamily
  double viscosity;               ///< eta [Pa s] >= 0
  double length = 0.;             ///< l [m] > 0, undeformed; needed for the gradient part alone
};

/// Checks a family. Throws InvalidMaterial unless the direction is a unit vector to 1e-12, the weight is positive, the
/// viscosity is not negative, and all are finite.
void check(const FibreDashpot &dashpot);

/// Kelvin-Voigt damping of a network of fibres, each of which resists the rate of its own stretch (theory-continuum.md,
/// eqs. (C.41), (C.42)):
///   P = sum over families of  c_k eta_k (n_k . Fdot N_k) n_k (x) N_k,   n = F N / |F N|
/// With c = A0 l/V it models the dashpots of a lattice of bonds.
class FibreViscosity : public Viscosity
{
public:
  /// Creates the law, with the GradientViscosity of the micro-inertia length `gradient_length` l_d [m] unless that is
  /// 0. Throws InvalidMaterial if there is no dashpot or one is not valid, and as GradientViscosity does.
  explicit FibreViscosity(std::vector<FibreDashpot> dashpots, double gradient_length = 0.);

  dealii::Tensor<2, 2> stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;
  dealii::Tensor<4, 2> stress_by_F(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;
  dealii::Tensor<4, 2> stress_by_rate(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;

  const GradientViscosity *gradient() const override { return gradient_.get(); }

  const std::vector<FibreDashpot> &dashpots() const { return dashpots_; }

private:
  std::vector<FibreDashpot> dashpots_;
  std::shared_ptr<const GradientViscosity> gradient_;
};
} // namespace latcon::continuum
