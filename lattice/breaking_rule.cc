#include "lattice/breaking_rule.h"

#include "support/require.h"

namespace latcon::lattice
{

CriticalStretch::CriticalStretch(double stretch, double factor, double time) : factor_(factor), time_(time)
{
  support::require(stretch > 0., "the breaking stretch must be positive");
  stretch_.fill(stretch);
}

double CriticalStretch::limit(const Bond &bond) const
{
  const double rate = factor_ > 1. ? time_ * std::max(bond.rate, 0.) : 0.;
  return stretch_[bond.shell] * (1. + (factor_ - 1.) * (rate / (1. + rate))) * bond.toughening * bond.strength;
}

BondEnergy::BondEnergy(const Material &material, double energy) : material_(material), energy_(energy)
{
  support::require(energy > 0., "the critical energy of bonds must be positive");
}

double BondEnergy::stretch_at(std::size_t shell, double energy) const
{
  constexpr double longest = 1e6; // beyond it no law is evaluated
  const BondLaw &law = material_.in_shell(shell)->law;
  const auto stored = [&](double stretch) { return lattice::energy(law, stretch) - lattice::energy(law, 1.); };
  if (!(energy > 0.))
    return 1.;
  double low = 1., high = 2.;
  for (; high < longest && stored(high) < energy; high *= 2.)
    low = high;
  if (high >= longest)
    return std::numeric_limits<double>::infinity();
  while (high - low > 4e-16 * high)
  {
    const double middle = 0.5 * (low + high);
    (stored(middle) < energy ? low : high) = middle;
  }
  return high;
}

double BondEnergy::limit(const Bond &bond) const
{
  return stretch_at(bond.shell, energy_ * bond.toughening * bond.strength / bond.stiffness);
}

// The energy grows faster than the stretch beyond 1, so that the strongest bond has the smallest limit over its
// strength.
double BondEnergy::smallest_limit(double toughening) const
{
  const double strongest = material_.disorder.strength.largest();
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t shell = 0; shell < n_shells; ++shell)
    if (material_.in_shell(shell) != nullptr)
      smallest = std::min(smallest,
                          stretch_at(shell, energy_ * toughening * strongest / material_.disorder.stiffness.largest()));
  return smallest / strongest;
}

} // namespace latcon::lattice
