#pragma once

#include <cstddef>
#include <memory>

#include "lattice/bonds/memory_limits.h"

namespace latcon::lattice
{

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
