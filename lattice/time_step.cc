#include "lattice/time_step.h"

#include <algorithm>
#include <cmath>

#include "lattice/chebyshev_stages.h"
#include "lattice/contact.h"

namespace lattice
{
namespace
{

struct Rates
{
  double omega_square = 0.; // [1/s^2]
  double gamma = 0.;        // [1/s]
};

// Of Runge-Kutta-Chebyshev: where the crack of Fig. 1 still runs as with steps twenty times shorter (theory.md, section
// "Long steps").
constexpr double share_of_elastic_limit = 0.35;

TimeStepLimits limits(const Rates &rates)
{
  const auto &[omega_square, gamma] = rates;
  return {2. / std::sqrt(omega_square), 1. / gamma, 2. / (gamma + std::sqrt(gamma * gamma + omega_square))};
}

Rates bound_of_bonds(const TriangularLattice &lattice, const Material &material, double smallest_stretch)
{
  const double mass = site_mass(material, lattice);
  Rates rates;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const Shell *shell = material.shell(kind))
    {
      // A site has two bonds of each kind, and the bound is twice the sum over its bonds.
      const double per_length = 4. * cross_section(*shell, lattice) / (lattice.rest_length(kind) * mass);
      rates.omega_square += per_length * largest_stiffness(shell->law, smallest_stretch);
      rates.gamma += per_length * shell->viscosity;
    }
  return rates;
}

} // namespace

TimeStepLimits time_step_limits(const TriangularLattice &lattice, const Material &material, double smallest_stretch)
{
  return limits(bound_of_bonds(lattice, material, smallest_stretch));
}

TimeStepLimits time_step_limits(const TriangularLattice &lattice, const Material &material, double smallest_stretch,
                                const ContactLaw &contact)
{
  Rates rates = bound_of_bonds(lattice, material, smallest_stretch);
  // Six neighbours around a site have sum n n = 3 I, and the bound is twice the sum.
  const double per_contact = 6. / site_mass(material, lattice);
  rates.omega_square = std::max(rates.omega_square, 0.5 * rates.omega_square + per_contact * contact.stiffness);
  rates.gamma = std::max(rates.gamma, 0.5 * rates.gamma + per_contact * contact.viscosity);
  return limits(rates);
}

double chebyshev_step(const TriangularLattice &lattice, const Material &material, double smallest_stretch)
{
  double step = share_of_elastic_limit * time_step_limits(lattice, material, 1.).elastic;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const Shell *shell = material.shell(kind))
      step = std::min(step, shell->viscosity / largest_stiffness(shell->law, smallest_stretch));
  return step;
}

TimeStepping chebyshev_time_stepping(double step, const TimeStepLimits &limits, unsigned int stages)
{
  if (stages == 0)
    return {step, ChebyshevStages::needed(step / limits.viscous)};
  return {std::min(step, ChebyshevStages(stages).real_limit() * limits.viscous), stages};
}

} // namespace lattice
