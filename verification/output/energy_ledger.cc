#include "verification/output/energy_ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/largest_error.h"

namespace latcon::output
{
namespace
{

// Of the energies of the sheet: sums of some 1e6 terms, over some 1e6 steps.
constexpr double round_off = 1e-12;

} // namespace

void LedgerCheck::add(const LedgerState &state)
{
  if (n_states_++ == 0)
    first_ = last_ = state;
  largest_imbalance_ = support::largest_of({largest_imbalance_, std::abs(state.imbalance)});
  largest_energy_ = support::largest_of({largest_energy_, state.stored + state.kinetic});
  largest_work_ = support::largest_of({largest_work_, std::abs(state.work)});
  largest_conversion_ = support::largest_of({largest_conversion_, std::abs(state.kinetic - first_.kinetic)});
  if (state.time > last_.time)
  {
    const double change = std::abs(state.kinetic - last_.kinetic) + std::abs(state.work - last_.work) + state.viscous -
                          last_.viscous + state.broken - last_.broken;
    const double duration = state.time - last_.time, power = change / duration;
    largest_power_ = support::largest_of({largest_power_, power});
    if (n_states_ > 2 || first_.kinetic == 0.) // at rest there is no power
      largest_surge_ = support::largest_of({largest_surge_, std::abs(power - power_) / duration});
    power_ = power;
  }
  last_ = state;
}

double LedgerCheck::exchanged() const
{
  const double broken = last_.broken - first_.broken, spent = broken + last_.viscous;
  return broken > 0. ? spent : spent + largest_work_ + largest_conversion_;
}

double LedgerCheck::imbalance(double at_rest) const
{
  if (n_states_ == 0)
    return std::numeric_limits<double>::quiet_NaN();
  if (largest_imbalance_ <= round_off * largest_energy_ + at_rest)
    return 0.;
  return largest_imbalance_ / exchanged();
}

double LedgerCheck::rate() const
{
  const double X = exchanged();
  return largest_power_ > 0. ? support::largest_of({largest_power_ / X, std::sqrt(0.5 * largest_surge_ / X)}) : 0.;
}

Tolerance allowed_imbalance(input::Case::Integrator integrator, double n_steps, double lost)
{
  const double n = support::largest_of({n_steps, 1.});
  if (integrator == input::Case::Integrator::velocity_verlet)
    return {support::largest_of({2e-4, 0.1 / n}),
            "five times the largest of shipped cases at the automatic step; a tenth of a step of the start"};
  return {support::largest_of({5e-3, lost / n}),
          "three times the largest of shipped cases at the automatic step; twice what a start costs"};
}

Tolerance allowed_imbalance_of_implicit_motion(double rate, double step)
{
  return {std::clamp(std::pow(rate * step, 2), 1e-6, 1e-2), "second order in the step (L.39), at most 1e-2"};
}

} // namespace latcon::output
