#pragma once

#include <deal.II/base/tensor.h>

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
};

/// Checks a family. Throws InvalidMaterial unless the direction is a unit vector to 1e-12, there is a branch, weight,
/// moduli and relaxation times are positive, and all are finite.
void check(const MaxwellFibres &fibres);

/// Maxwell branches of a network of fibres, parallel to its elastic law and its viscosity (theory-viscoelastic.md, eq.
/// (V.1)):
///   P = sum over families k and branches i of  c_k q_ki n_k (x) N_k,   q_ki' = E_i l_k' - q_ki / tau_i,   l_k = |F
///   N_k|
/// The overstresses q [Pa] are the history of a material point: n_variables() numbers, families in their order, the
/// branches of each in turn. Const and stateless; the caller stores the history.
class FibreMemory
{
public:
  /// Creates the law. Throws InvalidMaterial if there is no family or one is not valid.
  explicit FibreMemory(std::vector<MaxwellFibres> families);

  const std::vector<MaxwellFibres> &families() const { return families_; }
  std::size_t n_variables() const { return n_variables_; }
  std::size_t n_numbers() const { return n_numbers_; } ///< of branches in energy ledgers

  /// Coefficients of an update over one duration, per variable (theory-viscoelastic.md, eqs. (V.2), (V.5)).
  struct Step
  {
    /// Coefficients of one variable.
    struct Coefficients
    {
      double decay;      ///< e^(-h/tau) [-]
      double gain;       ///< E (1 - e^(-h/tau)) tau/h [Pa]; E for h = 0
      double of_squares; ///< dissipated energy per q^2 [1/Pa]
      double of_product; ///< dissipated energy per q dl [-]
      double of_change;  ///< dissipated energy per dl^2 [Pa]
    };
    std::vector<Coefficients> coefficients;
  };

  /// Returns the coefficients for the duration h [s] >= 0.
  Step step(double duration) const;

  /// Computes the stretches l [-] of all families. Throws NonPhysicalState if det F <= 0 or not finite.
  void stretches(const dealii::Tensor<2, 2> &F, double *l) const;

  /// Updates the overstresses q [Pa] exactly for stretches that change linearly in time from `before` to `now` [-].
  void advance(const Step &step, const double *before, const double *now, double *q) const;

  /// Adds the energies of the branches [J/m^3] by their numbers.
  /// @param q overstresses [Pa]
  void add_stored(const double *q, double *by_number) const;

  /// Adds the energies that the branches dissipate in an update [J/m^3] by their numbers: exact integrals of
  /// q^2 / (E tau) on the path of advance(). @param q overstresses before the update [Pa]
  void add_dissipated(const Step &step, const double *before, const double *now, const double *q,
                      double *by_number) const;

  /// Returns the first Piola stress P_iJ [Pa] of the overstresses q.
  dealii::Tensor<2, 2> stress(const dealii::Tensor<2, 2> &F, const double *q) const;

  /// Returns dP_iJ/dF_kL [Pa] with q advanced by `step` to F (theory-viscoelastic.md, eq. (V.3)), index order
  /// [i][J][k][L], major symmetric.
  /// @param q overstresses after the update, those of stress()
  dealii::Tensor<4, 2> tangent(const Step &step, const dealii::Tensor<2, 2> &F, const double *q) const;

private:
  std::vector<MaxwellFibres> families_;
  std::size_t n_variables_ = 0;
  std::size_t n_numbers_ = 0;
};
} // namespace latcon::continuum
