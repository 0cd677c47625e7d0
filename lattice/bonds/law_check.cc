#include "lattice/bonds/law_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/text_wrap.h"

namespace latcon::lattice
{
namespace
{

constexpr double grid_step = 0.01, difference_step = 1e-4; // relative; the wider differences reach twice as far

std::string text(double number)
{
  return std::isnan(number) ? "nan" : support::text_of(number); // whatever its sign
}

std::string name(std::size_t derivative)
{
  return "psi" + std::string(derivative, '\'');
}

// A central difference of step h is off by the round-off of the function, eps |f| / h, and by h^2 f''' / 6, of which
// that of step 2 h has four times as much: their difference is three times the error of the former.
void check_slope(const std::function<double(double)> &function, const std::function<double(double)> &slope,
                 std::size_t derivative, double stretch)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const double h = difference_step * stretch;
  double largest = 0.;
  const auto quotient = [&](double distance)
  {
    const double above = function(stretch + distance), below = function(stretch - distance);
    largest = std::max({largest, std::abs(above), std::abs(below)});
    return (above - below) / (2. * distance);
  };
  const double difference = quotient(h), wider = quotient(2. * h), given = slope(stretch);
  if (!std::isfinite(difference) || !std::isfinite(wider)) // the tolerance would be infinite
    throw InvalidBondLaw(name(derivative - 1) + " is not finite near stretch " + text(stretch));
  // Values are sums of terms that may be a hundred times larger than they are.
  const double tolerance = std::abs(wider - difference) + 100. * eps * largest / h + 1e-9 * std::abs(given);
  if (!(std::abs(given - difference) <= tolerance)) // also for no number
    throw InvalidBondLaw(name(derivative) + " is " + text(given) + " Pa at stretch " + text(stretch) +
                         ", but differences of " + name(derivative - 1) + " give " + text(difference) + " Pa");
  // Across a pole or a jump psi or psi' may fall though all slopes rise, or the other way round; psi'' may jump.
  const double from = std::max(stretch / (1. + grid_step), smallest_checked_stretch),
               rise = function(stretch) - function(from);
  if (derivative <= 2 && std::abs(rise) > 1e-12 * largest && given * rise < 0. && slope(from) * rise < 0. &&
      slope(0.5 * (from + stretch)) * rise < 0.)
    throw InvalidBondLaw(name(derivative - 1) + " is not continuous between stretches " + text(from) + " and " +
                         text(stretch));
}

double bound_at(const CustomBondLaw &law, double stretch)
{
  const double bound = std::max(law.stiffness(stretch), law.force(stretch) / stretch);
  const bool has_value = !std::isnan(bound + law.force(stretch) + law.energy(stretch));
  return has_value ? bound : std::numeric_limits<double>::infinity();
}

// Stretches from `shortest` to `longest`, each farther from the one before by a relative step.
std::vector<double> grid(double shortest, double longest, double step)
{
  std::vector<double> stretches;
  for (double stretch = shortest; stretch < longest; stretch *= 1. + step)
    stretches.push_back(stretch);
  stretches.push_back(longest);
  return stretches;
}

} // namespace

void check_law(const std::vector<std::function<double(double)>> &functions, double longest)
{
  const double stiffness = functions[2](1.);
  if (!(stiffness > 0. && std::isfinite(stiffness)))
    throw InvalidBondLaw("psi''(1) is " + text(stiffness) + " Pa; a bond at rest needs a stiffness > 0");
  if (!(std::abs(functions[1](1.)) <= 1e-12 * stiffness))
    throw InvalidBondLaw("psi'(1) is " + text(functions[1](1.)) + " Pa; a bond at rest has no force");
  const std::vector<double> stretches = grid(smallest_checked_stretch, longest, grid_step);
  for (std::size_t derivative = 0; derivative < functions.size(); ++derivative)
    for (const double stretch : stretches)
    {
      if (const double value = functions[derivative](stretch); !std::isfinite(value))
        throw InvalidBondLaw(name(derivative) + " is " + text(value) + " at stretch " + text(stretch) +
                             "; it must be finite for all stretches of bonds, " + text(smallest_checked_stretch) +
                             " to " + text(longest));
      if (derivative > 0 && stretch * (1. + 2. * difference_step) <= longest &&
          stretch * (1. - 2. * difference_step) >= smallest_checked_stretch)
        check_slope(functions[derivative - 1], functions[derivative], derivative, stretch);
    }
}

// Between two stretches of the grid a smooth law differs from them by (step^2 / 8) lam^2 psi'''', less than 1e-4 of
// psi'' for powers up to the 10th; automatic time steps have a larger margin.
void CheckedLaw::check(double longest)
{
  check_law({[this](double l) { return energy(l); }, [this](double l) { return force(l); },
             [this](double l) { return stiffness(l); }},
            longest);
  const std::vector<double> stretches = grid(0.05, longest, 0.003);
  double largest = 0.;
  for (auto stretch = stretches.rbegin(); stretch != stretches.rend(); ++stretch)
    largest_[*stretch] = largest = std::max(largest, bound_at(*this, *stretch));
}

double CheckedLaw::largest_stiffness(double smallest_stretch) const noexcept
{
  const auto next = largest_.lower_bound(smallest_stretch);
  const double there = bound_at(*this, smallest_stretch);
  return next == largest_.end() ? there : std::max(there, next->second);
}

} // namespace latcon::lattice
