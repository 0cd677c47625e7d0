#pragma once

#include <deal.II/base/tensor.h>

#include <vector>

namespace latcon::continuum
{
/// A viscous law of a sheet: a stress that resists the rate of deformation, added to the elastic one. Const and
/// stateless. F and densities as in Material; Fdot_iJ = dv_i/dX_J [1/s]. All functions throw NonPhysicalState when
/// F is not a deformation (det F <= 0, not finite).
class Viscosity
{
public:
  virtual ~Viscosity() = default;

  /// First Piola stress P_iJ [Pa]. Objective: zero for Fdot = W F with W antisymmetric.
  virtual dealii::Tensor<2, 2> stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// dP_iJ/dF_kL [Pa], index order [i][J][k][L]. Not major symmetric.
  virtual dealii::Tensor<4, 2> stress_by_F(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// dP_iJ/dFdot_kL [Pa s], index order [i][J][k][L].
  virtual dealii::Tensor<4, 2> stress_by_rate(const dealii::Tensor<2, 2> &F,
                                              const dealii::Tensor<2, 2> &Fdot) const = 0;

  /// Power lost P : Fdot >= 0 [W/m^3].
  double dissipation(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const;
};

/// Dashpots of one reference direction.
struct FibreDashpot
{
  dealii::Tensor<1, 2> direction; ///< unit vector N_J [-], reference configuration
  double weight;                  ///< c [-] > 0, as of a FibreFamily
  double viscosity;               ///< eta [Pa s] >= 0
};

/// Throws InvalidMaterial, unless the direction is a unit vector to 1e-12, the weight is positive and the viscosity is
/// not negative, all of them finite.
void check(const FibreDashpot &dashpot);

/// Kelvin damping of a network of fibres, each of which resists the rate of its own stretch (theory-continuum.md,
/// eqs. (C.41), (C.42)):
///   P = sum over families of  c_k eta_k (n_k . Fdot N_k) n_k (x) N_k,   n = F N / |F N|
/// The dashpots of a lattice of bonds, with c = A0 l/V.
class FibreViscosity : public Viscosity
{
public:
  /// Throws InvalidMaterial if there is no dashpot or one is not valid.
  explicit FibreViscosity(std::vector<FibreDashpot> dashpots);

  dealii::Tensor<2, 2> stress(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;
  dealii::Tensor<4, 2> stress_by_F(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;
  dealii::Tensor<4, 2> stress_by_rate(const dealii::Tensor<2, 2> &F, const dealii::Tensor<2, 2> &Fdot) const override;

  const std::vector<FibreDashpot> &dashpots() const { return dashpots_; }

private:
  std::vector<FibreDashpot> dashpots_;
};
} // namespace latcon::continuum
