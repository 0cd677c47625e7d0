#pragma once

#include <cstddef>

#include "verification/input/case.h"
#include "verification/output/results.h"

namespace latcon::output
{

/// State of the energy ledger of a motion of either side, per unit thickness [J/m].
struct LedgerState
{
  double time;      ///< [s]
  double stored;    ///< elastic energy, that of strain gradients and of Maxwell branches included
  double kinetic;   ///< that of micro-inertia included
  double viscous;   ///< dissipated since the start, by Maxwell branches too
  double broken;    ///< spent on breaking, since the start or with the seed
  double work;      ///< done on the sheet since the start
  double imbalance; ///< error of the sum of all energies

  /// Saves or loads the state, for checkpoints.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("time", time);
    archive("stored", stored);
    archive("kinetic", kinetic);
    archive("viscous", viscous);
    archive("broken", broken);
    archive("work", work);
    archive("imbalance", imbalance);
  }
};

/// Imbalance of the energy ledger of a motion over the energy that the motion exchanged (theory.md, eq. (L.38)).
class LedgerCheck
{
public:
  /// Adds a state; times must increase. The first state is that of the start, with the seed cut.
  void add(const LedgerState &state);

  /// Returns the energy exchanged since the start [J/m]: spent by the crack or, while nothing broke, dissipated,
  /// supplied and converted.
  double exchanged() const;

  /// Returns the largest |imbalance| over exchanged() [-]; 0 where it is round-off of the energies of the sheet or of
  /// one at rest, NaN without a state or with one that is not finite. @param at_rest energy_at_rest() of the sheet
  double imbalance(double at_rest) const;

  /// Returns the angular frequency of an oscillation with the largest power between two states, or the largest change
  /// of power, that exchanges the same energy [1/s]; 0 where nothing was exchanged.
  double rate() const;

  /// Saves or loads the states added so far, for checkpoints.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("n_states", n_states_);
    archive("first", first_);
    archive("last", last_);
    archive("largest_imbalance", largest_imbalance_);
    archive("largest_energy", largest_energy_);
    archive("largest_work", largest_work_);
    archive("largest_conversion", largest_conversion_);
    archive("largest_power", largest_power_);
    archive("power", power_);
    archive("largest_surge", largest_surge_);
  }

private:
  std::size_t n_states_ = 0;
  LedgerState first_{}, last_{};
  double largest_imbalance_ = 0., largest_energy_ = 0., largest_work_ = 0., largest_conversion_ = 0.; // [J/m]
  double power_ = 0., largest_power_ = 0., largest_surge_ = 0.; // last and largest [W/m], its change [W/(m s)]
};

/// Returns the energy that round-off can leave in a sheet at rest, of strains of 1e-10 [J/m]. @param area [m^2]
inline double energy_at_rest(const lattice::Material &material, double area)
{
  return 1e-20 * lattice::stiffness(material.nearest.law, 1.) * area;
}

// Largest LedgerCheck::imbalance() with which a motion holds: multiples of the imbalances that shipped cases have at
// the automatic step (docs/verification.md, "Energy ledger"). A longer step does not raise them. `n_steps` is the
// duration over the automatic step: steps do not resolve the start of a motion, the decay of its noise and the recoil
// of its seed.

/// Tolerance of a motion of the lattice [-]. @param n_steps in which it exchanges its energy; without a crack,
/// theory.md, eq. (L.40) @param lost steps of Runge-Kutta-Chebyshev whose energy its start may cost: 2 of a crack,
/// otherwise 4
Tolerance allowed_imbalance(input::Case::Integrator integrator, double n_steps, double lost);

/// Tolerance of an implicit motion without a crack [-], theory.md, eq. (L.39).
/// @param rate LedgerCheck::rate() [1/s] @param step [s]
Tolerance allowed_imbalance_of_implicit_motion(double rate, double step);

} // namespace latcon::output
