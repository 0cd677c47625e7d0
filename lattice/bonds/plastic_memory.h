#include "lattice/bonds/formulas.h"
#include "lattice/bonds/memory_limits.h"

#ifndef LATCON_LATTICE_PLASTIC_MEMORY
#include <cmath>

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
#endif

#if !defined(LATCON_LATTICE_PLASTIC_MEMORY) || defined(LATCON_VECTORS)
#define LATCON_LATTICE_PLASTIC_MEMORY
namespace latcon::lattice::LATCON_FORMULAS
{

#ifndef LATCON_VECTORS
/// For vectors see lanes.inc.
inline double excess(double value, double limit)
{
  const double beyond = std::abs(value) - limit;
  return beyond > 0. ? beyond : 0.;
}
inline double clamped(double value, double limit)
{
  return value > limit ? limit : value < -limit ? -limit : value;
}
#endif

/// Updates the variables of a bond while its stretch changes from `before` to `now`.
/// @param dissipation energy that the slider dissipates meanwhile per reference volume of the bond, eq. (L.43) [Pa]
/// @return q at the end [Pa]; beyond the yield stress it is that of the new alpha to the bit, so that nothing slips
/// further while the stretch stays
template <class Number>
inline Number advance(const PlasticMemory::Step &step, Number before, Number now, Number *variables,
                      Number *dissipation)
{
  const Number trial = variables[0] + step.modulus * (now - before);
  const Number yield = step.yield_stress + step.hardening * variables[1];
  const Number slipped = step.slip * excess(trial, yield);
  dissipation[0] = slipped * (yield + (0.5 * step.hardening) * slipped);
  variables[1] = variables[1] + slipped;
  variables[0] = clamped(trial, step.yield_stress + step.hardening * variables[1]);
  return variables[0];
}

} // namespace latcon::lattice::LATCON_FORMULAS
#endif
