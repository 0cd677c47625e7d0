#pragma once

#include "continuum/fibre_strain.h"

#include <memory>
#include <vector>

namespace latcon::continuum
{
/// Spring E in series with a dashpot E tau.
struct MaxwellBranch
{
  double modulus;         ///< E [Pa] > 0
  double relaxation_time; ///< tau [s] > 0
};

/// Family of fibres with one reference direction and Maxwell branches.
struct MaxwellFibres
{
  dealii::Tensor<1, 2> direction;      ///< unit vector N_J [-], reference configuration
  double weight;                       ///< c [-] > 0, as in FibreFamily
  std::vector<MaxwellBranch> branches; ///< one or more
  /// Number of the first branch in energy ledgers, from 0; branches with the same number are recorded together.
  std::size_t first_number;
  double length = 0.; ///< l [m] > 0, undeformed; needed for the gradient part alone
};

/// Maxwell branches of a network of fibres, parallel to its elastic law and its viscosity (theory-viscoelastic.md, eq.
/// (V.1)):
///   P = sum over families k and branches i of  c_k q_ki n_k (x) N_k,   q_ki' = E_i l_k' - q_ki / tau_i,   l_k = |F
///   N_k|
/// The gradient part is a law of the same kind, with the gradient of the stretch along N and its normal T in place of
/// the stretch and weights c_k (l_d^2 - l_k^2/12) and c_k l_d^2 (eq. (V.9)), as that of FibreViscosity.
///
/// The overstresses q [Pa], of a gradient [Pa/m], are the history of a material point: n_variables() numbers, strains
/// in their order, the branches of each in turn. Const and stateless; the caller stores the history.
class FibreMemory
{
public:
  /// Creates the law, with the gradient part of the micro-inertia length `gradient_length` l_d [m] unless that is 0.
  /// Throws InvalidInput if there is no family or one without branch, if a direction is not a unit vector to 1e-12,
  /// or weights, moduli and relaxation times not positive and finite, and as gradient_measures() does.
  explicit FibreMemory(std::vector<MaxwellFibres> families, double gradient_length = 0.);

  const std::vector<MaxwellFibres> &families() const { return families_; }
  double gradient_length() const { return gradient_length_; }
  /// Returns the part that depends on the second derivatives of u, those of the lifted gradients; nullptr: none. It
  /// requires a sheet with a gradient law.
  const FibreMemory *gradient() const { return gradient_.get(); }

  std::size_t n_strains() const { return strains_.size(); }
  std::size_t n_variables() const { return variables_.size(); }
  std::size_t n_numbers() const { return n_numbers_; } ///< of branches in energy ledgers

  /// Coefficients of one variable in an update over one duration (theory.md, eq. (L.28), and (V.5)).
  struct Coefficients
  {
    double decay;      ///< e^(-h/tau) [-]
    double gain;       ///< E (1 - e^(-h/tau)) tau/h [Pa]; E for h = 0
    double of_squares; ///< dissipated energy per q^2 [1/Pa]
    double of_product; ///< dissipated energy per q dl [-]
    double of_change;  ///< dissipated energy per dl^2 [Pa]
  };
  using Step = std::vector<Coefficients>; ///< of all variables

  /// Returns the coefficients for the duration h [s] >= 0.
  Step step(double duration) const;

  /// Computes the strains [-], of a gradient [1/m], at a point. Throws NonPhysicalState if det F <= 0 or not finite.
  void strains(const FieldDerivatives &u, double *e) const;

  /// Updates the overstresses exactly for strains that change linearly in time from `before` to `now`.
  void advance(const Step &step, const double *before, const double *now, double *q) const;

  /// Sets the overstresses of the branches with this number to those after a sudden change from `relaxed` to `now`.
  void set_sudden(std::size_t number, const double *relaxed, const double *now, double *q) const;

  /// Adds the energies of the branches [J/m^3] by their numbers.
  void add_stored(const double *q, double *by_number) const;

  /// Adds the energies that the branches dissipate in an update [J/m^3] by their numbers: exact integrals of
  /// q^2 / (E tau) on the path of advance(). @param q overstresses before the update
  void add_dissipated(const Step &step, const double *before, const double *now, const double *q,
                      double *by_number) const;

  /// Adds the first derivatives of a density at a point, the stresses of the overstresses q, and with Order::second
  /// their derivatives with q advanced by `step` to u (theory-viscoelastic.md, eq. (V.3)), which are symmetric.
  /// @param q overstresses after the update
  void add_density(const Step &step, const FieldDerivatives &u, const double *q, Order order,
                   PointIntegrand &density) const;

private:
  // A branch of one strain, whose variable has its number in the list.
  struct Variable
  {
    std::size_t strain;
    double weight; // of the strain
    MaxwellBranch branch;
    std::size_t number; // in energy ledgers
  };

  void add(const StrainMeasure &strain, const MaxwellFibres &fibres);

  std::vector<MaxwellFibres> families_;
  double gradient_length_ = 0.;
  std::vector<StrainMeasure> strains_;
  std::vector<Variable> variables_; // in the order of their strains
  std::size_t n_numbers_ = 0;
  std::shared_ptr<const FibreMemory> gradient_;
};
} // namespace latcon::continuum
