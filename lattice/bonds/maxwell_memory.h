#pragma once

#include <array>
#include <vector>

#include "lattice/bonds/memory_limits.h"

namespace latcon::lattice
{

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

} // namespace latcon::lattice
