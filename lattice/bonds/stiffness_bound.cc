#include "lattice/bonds/stiffness_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace latcon::lattice
{
namespace
{

// Between two stretches a smooth law differs from them by (step^2 / 8) lam^2 psi'''', less than 1e-4 of psi'' for
// powers up to the 10th; automatic time steps have a larger margin.
constexpr double first = 0.05;
constexpr double step = 0.003; // relative

double bound_at(const CustomBondLaw &law, double stretch)
{
  const double bound = std::max(law.stiffness(stretch), law.force(stretch) / stretch);
  const bool has_value = !std::isnan(bound + law.force(stretch) + law.energy(stretch));
  return has_value ? bound : std::numeric_limits<double>::infinity();
}

} // namespace

StiffnessBound::StiffnessBound(const CustomBondLaw &law, double longest)
{
  for (double stretch = first; stretch < longest; stretch *= 1. + step)
    stretches_.push_back(stretch);
  stretches_.push_back(longest);
  for (const double stretch : stretches_)
    largest_.push_back(bound_at(law, stretch));
  for (std::size_t i = largest_.size() - 1; i-- > 0;)
    largest_[i] = std::max(largest_[i], largest_[i + 1]);
}

double StiffnessBound::from(const CustomBondLaw &law, double smallest) const
{
  const auto next = std::lower_bound(stretches_.begin(), stretches_.end(), smallest);
  const double there = bound_at(law, smallest);
  return next == stretches_.end() ? there
                                  : std::max(there, largest_[static_cast<std::size_t>(next - stretches_.begin())]);
}

} // namespace latcon::lattice
