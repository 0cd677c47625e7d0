#ifndef LATCON_LATTICE_BONDS_MEMORIES_H
#define LATCON_LATTICE_BONDS_MEMORIES_H

#include <array>
#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

/// @file
/// Memories of bonds: overstresses q that depend on the past of a bond through a number of variables per bond,
///   sigma = psi'(lam) + eta lam' + q   (theory.md, eq. (L.27)).
///
/// A memory declares its MemoryProperties. `set_duration` prepares it for updates over one duration [s], >= 0, at first
/// 0; `advance` (last in this file) is the formula of an update. Variables are 0 at rest and are stored by BondHistory.
namespace latcon::lattice
{

/// Most history variables that a memory may have per bond.
inline constexpr std::size_t max_history_variables = 16;

/// Properties of a memory that no motion changes.
struct MemoryProperties
{
  std::size_t n_variables;  ///< per bond, 0 for no memory
  std::size_t n_mechanisms; ///< whose energies are recorded one by one, at most n_variables
  double largest_stiffness; ///< bound on the axial stiffness dq/dlam that it adds in fast motion [Pa]
  bool dissipates_energy;   ///< whether `advance` gives the energy that each mechanism dissipates, or else its power
};

/// Generalised Maxwell branches parallel to the elastic law and the dashpot of a bond (theory.md, eq. (L.27)):
///   q_i' = E_i lam' - q_i / tau_i,   sigma = psi'(lam) + eta lam' + sum_i q_i.
/// The variables of a bond are its overstresses q_i [Pa]. An update is exact for a stretch that changes linearly in
/// time (theory.md, eq. (L.28)), and energy and dissipation are those of theory.md, eq. (L.29).
class MaxwellMemory : public MemoryProperties
{
public:
  /// A spring E in series with a dashpot E tau.
  struct Branch
  {
    double modulus;         ///< E [Pa], > 0
    double relaxation_time; ///< tau [s], > 0
  };

  /// @param branches at most max_history_variables of them; none: the bond has no memory
  /// @throws std::invalid_argument for more branches, or one whose constants are not positive and finite
  explicit MaxwellMemory(std::vector<Branch> branches = {});

  const std::vector<Branch> &branches() const { return branches_; }

  /// Energy in the spring of one branch per reference volume of the bond, q_i^2 / (2 E_i) [Pa].
  double stored_energy(std::size_t branch, double /*stretch*/, const double *overstress) const
  {
    return 0.5 * overstress[branch] * overstress[branch] / branches_[branch].modulus;
  }

  void set_duration(double duration);

  // Coefficients of an update over h.
  std::array<double, max_history_variables> decay{};   ///< e^(-h/tau) [-]
  std::array<double, max_history_variables> gain{};    ///< E tau/h (1 - e^(-h/tau)) [Pa]; E for h = 0
  std::array<double, max_history_variables> fluency{}; ///< 1 / (E tau) [1 / (Pa s)]

private:
  std::vector<Branch> branches_;
};

/// A spring in series with a friction slider that hardens, parallel to the elastic law and the dashpot of a bond:
/// plastic stretch that does not depend on the rate (theory.md, eq. (L.41)). The variables of a bond are its overstress
/// q [Pa] and its accumulated plastic stretch alpha [-]. An update is exact for a stretch that changes in one direction
/// (theory.md, eq. (L.42)), over any duration.
struct PlasticMemory : MemoryProperties
{
  /// @param E modulus of the spring [Pa], > 0
  /// @param Y yield stress [Pa] below which the slider is at rest, > 0
  /// @param K hardening [Pa], >= 0: growth of the yield stress with alpha
  /// @throws std::invalid_argument for others
  PlasticMemory(double E, double Y, double K);

  double modulus, yield_stress, hardening; ///< E, Y, K [Pa]
  double slip;                             ///< 1 / (E + K) [1/Pa]

  /// Energy in the spring per reference volume of the bond, q^2 / (2 E) [Pa].
  double stored_energy(std::size_t /*mechanism*/, double /*stretch*/, const double *variables) const
  {
    return 0.5 * variables[0] * variables[0] / modulus;
  }
  void set_duration(double /*duration*/) {}
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

/// A bond with a user-defined memory, whose energies are those of the law as a whole.
class CustomMemory : public MemoryProperties
{
public:
  /// @throws std::invalid_argument without a law, or for one with another number of variables than allowed, without a
  /// finite stiffness >= 0, or with overstress, stored energy or dissipation at rest
  explicit CustomMemory(std::shared_ptr<const CustomMemoryLaw> law);

  const CustomMemoryLaw &law() const { return *law_; }
  double stored_energy(std::size_t /*mechanism*/, double stretch, const double *variables) const
  {
    return law_->stored_energy(stretch, variables);
  }
  void set_duration(double duration) { duration_ = duration; }
  double duration() const { return duration_; } ///< [s]

private:
  std::shared_ptr<const CustomMemoryLaw> law_;
  double duration_ = 0.;
};

/// Memory of the bonds of one shell; none by default.
using BondMemory = std::variant<MaxwellMemory, PlasticMemory, CustomMemory>;

/// Properties of a memory, which no motion changes.
inline const MemoryProperties &properties(const BondMemory &memory)
{
  return std::visit([](const MemoryProperties &m) -> const MemoryProperties & { return m; }, memory);
}
/// Energy that one mechanism stores per reference volume of a bond [Pa].
inline double stored_energy(const BondMemory &memory, std::size_t mechanism, double stretch, const double *variables)
{
  return std::visit([&](const auto &m) { return m.stored_energy(mechanism, stretch, variables); }, memory);
}
/// Sets the duration of the updates to come [s], >= 0.
inline void set_duration(BondMemory &memory, double duration)
{
  std::visit([duration](auto &m) { m.set_duration(duration); }, memory);
}

} // namespace latcon::lattice

#endif
#ifdef LATCON_BOND_FORMULAS // see formulas.inc

// Updates the n variables of the memory of a bond while its stretch changes from `before` to `now`.
// @param dissipation of each mechanism per reference volume of the bond: the power at the end [Pa/s], or the energy
// meanwhile [Pa] if it `dissipates_energy`
// @return overstress q at the end [Pa]

// The power is q_i^2 / (E_i tau_i), of the dashpot of each branch.
template <class Number>
inline Number advance(const MaxwellMemory &memory, std::size_t n, Number before, Number now, Number *overstress,
                      Number *dissipation)
{
  const Number change = now - before;
  Number sum{};
  for (std::size_t i = 0; i < n; ++i)
  {
    overstress[i] = memory.decay[i] * overstress[i] + memory.gain[i] * change;
    sum = i == 0 ? overstress[0] : sum + overstress[i];
    dissipation[i] = memory.fluency[i] * (overstress[i] * overstress[i]);
  }
  return sum;
}
// The energy is that of the slider, eq. (L.43). Beyond the yield stress q is that of the new alpha to the bit, so that
// nothing slips further while the stretch stays.
template <class Number>
inline Number advance(const PlasticMemory &memory, std::size_t /*n*/, Number before, Number now, Number *variables,
                      Number *dissipation)
{
  const Number trial = variables[0] + memory.modulus * (now - before);
  const Number yield = memory.yield_stress + memory.hardening * variables[1];
  const Number slipped = memory.slip * excess(trial, yield);
  dissipation[0] = slipped * (yield + (0.5 * memory.hardening) * slipped);
  variables[1] = variables[1] + slipped;
  variables[0] = clamped(trial, memory.yield_stress + memory.hardening * variables[1]);
  return variables[0];
}

#endif
