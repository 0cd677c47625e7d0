#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

/// @file
/// The memories that a bond may have (bond_memory.h).
namespace latcon::lattice
{

/// Most history variables that a memory may have per bond.
inline constexpr std::size_t max_history_variables = 16;

/// Generalised Maxwell branches parallel to the elastic law and the dashpot of a bond (theory.md, eq. (L.27)):
///   q_i' = E_i lam' - q_i / tau_i,   sigma = psi'(lam) + eta lam' + sum_i q_i.
/// The variables of a bond are its overstresses q_i [Pa]. An update is exact for a stretch that changes linearly in
/// time (theory.md, eq. (L.28)), and energy and dissipation are those of theory.md, eq. (L.29).
class MaxwellMemory
{
public:
  /// A spring E in series with a dashpot E tau.
  struct Branch
  {
    double modulus;         ///< E [Pa], > 0
    double relaxation_time; ///< tau [s], > 0
  };

  /// @param branches 1 to max_history_variables of them
  /// @throws std::invalid_argument for another number of branches, or one whose constants are not positive and finite
  explicit MaxwellMemory(std::vector<Branch> branches);

  const std::vector<Branch> &branches() const { return branches_; }
  std::size_t n_variables() const { return branches_.size(); }
  std::size_t n_mechanisms() const { return branches_.size(); }

  /// Axial stiffness that the branches add to that of the law in fast motion, sum E_i [Pa].
  double largest_stiffness() const;

  /// Energy in the spring of one branch per reference volume of the bond, q_i^2 / (2 E_i) [Pa].
  double stored_energy(std::size_t branch, double stretch, const double *overstress) const;

  /// Coefficients of an update over one duration.
  struct Step
  {
    static constexpr bool dissipates_energy = false;
    std::size_t n; ///< branches
    std::size_t n_mechanisms() const { return n; }
    std::array<double, max_history_variables> decay;   ///< e^(-h/tau) [-]
    std::array<double, max_history_variables> gain;    ///< E tau/h (1 - e^(-h/tau)) [Pa]; E for h = 0
    std::array<double, max_history_variables> fluency; ///< 1 / (E tau) [1 / (Pa s)]
  };
  /// @param duration h [s], >= 0
  Step step(double duration) const;

private:
  std::vector<Branch> branches_;
};

/// A spring in series with a friction slider that hardens, parallel to the elastic law and the dashpot of a bond:
/// plastic stretch that does not depend on the rate (theory.md, eq. (L.41)). The variables of a bond are its overstress
/// q [Pa] and its accumulated plastic stretch alpha [-]. An update is exact for a stretch that changes in one direction
/// (theory.md, eq. (L.42)).
class PlasticMemory
{
public:
  /// @param modulus E of the spring [Pa], > 0
  /// @param yield_stress Y [Pa] below which the slider is at rest, > 0
  /// @param hardening K [Pa], >= 0: growth of the yield stress with alpha
  /// @throws std::invalid_argument for others
  PlasticMemory(double modulus, double yield_stress, double hardening);

  std::size_t n_variables() const { return 2; }
  std::size_t n_mechanisms() const { return 1; }
  double largest_stiffness() const { return step_.modulus; }
  /// Energy in the spring per reference volume of the bond, q^2 / (2 E) [Pa].
  double stored_energy(std::size_t /*mechanism*/, double /*stretch*/, const double *variables) const
  {
    return 0.5 * variables[0] * variables[0] / step_.modulus;
  }

  /// Coefficients of an update, which are those of any duration.
  struct Step
  {
    static constexpr bool dissipates_energy = true; ///< see BondMemory
    static constexpr std::size_t n = 2;
    std::size_t n_mechanisms() const { return 1; }
    double modulus, yield_stress, hardening; ///< E, Y, K [Pa]
    double slip;                             ///< 1 / (E + K) [1/Pa]
  };
  Step step(double /*duration*/) const { return step_; }

private:
  Step step_;
};

/// User-defined memory of a bond: derive from it, and construct a Shell with a CustomMemory of it.
///
/// A memory adds an overstress q [Pa] to psi'(lam) and eta lam'. It depends on the variables of the bond, which are 0
/// in a bond at rest. Several threads call the functions at once: they may not change anything but the variables given
/// to them, nor throw.
class CustomMemoryLaw
{
public:
  virtual ~CustomMemoryLaw() = default;

  /// Number of variables per bond, 1 to max_history_variables.
  virtual std::size_t n_variables() const noexcept = 0;

  /// Updates the variables of a bond over `duration` [s], >= 0, in which its stretch changes from `before` to `now`. A
  /// duration of 0 with before == now must leave the bits of the variables as they are. The loop over all bonds calls
  /// this, each time from the variables at the start of a time step.
  /// @return q at the end [Pa], tension positive
  virtual double advance(double duration, double before, double now, double *variables) const noexcept = 0;

  /// Energy stored per reference volume of the bond [Pa]; its slope with the stretch at fixed dissipation is q:
  /// q lam' = d(stored_energy)/dt + dissipation.
  virtual double stored_energy(double stretch, const double *variables) const noexcept = 0;

  /// Returns whether what the law dissipates does not depend on the rate, as plastic stretch, softening or friction.
  virtual bool is_rate_independent() const noexcept { return false; }

  /// Power dissipated per reference volume of the bond [Pa/s], >= 0; of a rate-independent law the energy dissipated
  /// since the bond was at rest [Pa], which never decreases.
  virtual double dissipation(double stretch, const double *variables) const noexcept = 0;

  /// A bound [Pa] on the axial stiffness dq/dlam in fast motion; limits of the time step follow from it. |q| may not
  /// exceed this bound times the stretch.
  virtual double largest_stiffness() const noexcept = 0;
};

/// A bond with a user-defined memory.
class CustomMemory
{
public:
  /// @throws std::invalid_argument without a law, or for one with another number of variables than allowed, without a
  /// finite stiffness >= 0, or with overstress, stored energy or dissipation at rest
  explicit CustomMemory(std::shared_ptr<const CustomMemoryLaw> law);

  std::size_t n_variables() const { return law_->n_variables(); }
  /// Energies are those of the law as a whole.
  std::size_t n_mechanisms() const { return 1; }
  double largest_stiffness() const { return law_->largest_stiffness(); }
  double stored_energy(std::size_t /*mechanism*/, double stretch, const double *variables) const
  {
    return law_->stored_energy(stretch, variables);
  }

  /// An update over one duration.
  struct Step
  {
    const CustomMemoryLaw *law;
    double duration; ///< [s]
    std::size_t n;   ///< variables
    bool dissipates_energy;
    std::size_t n_mechanisms() const { return 1; }
  };
  Step step(double duration) const { return {law_.get(), duration, n_variables(), law_->is_rate_independent()}; }

private:
  std::shared_ptr<const CustomMemoryLaw> law_;
};

} // namespace latcon::lattice
