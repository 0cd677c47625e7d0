#pragma once

#include <cstddef>

#include "lattice/bonds/memory_limits.h"

namespace latcon::lattice
{

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

} // namespace latcon::lattice
