#include "lattice/time_step.h"

#include <cmath>

namespace lattice
{

TimeStepLimits time_step_limits(const TriangularLattice &lattice, const Material &material, double smallest_stretch)
{
  const double mass = site_mass(material, lattice);
  double omega_square = 0.;
  double gamma = 0.;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const Shell *shell = material.shell(kind))
    {
      // A site has two bonds of each kind, and the bound is twice the sum over its bonds.
      const double per_length = 4. * cross_section(*shell, lattice) / (lattice.rest_length(kind) * mass);
      omega_square += per_length * stiffness(shell->law, smallest_stretch);
      gamma += per_length * shell->viscosity;
    }
  return {2. / std::sqrt(omega_square), 1. / gamma, 2. / (gamma + std::sqrt(gamma * gamma + omega_square))};
}

} // namespace lattice
