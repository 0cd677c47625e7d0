#include "verification/claims/absolute_modulus.h"

#include <cmath>

namespace latcon::claims
{

double stiffness_at_rest(const lattice::BondLaw &law)
{
  if (const auto *rod = std::get_if<lattice::MooneyRivlinBond>(&law))
    return 3. * (rod->a + rod->b);
  if (const auto *spring = std::get_if<lattice::LinearBond>(&law))
    return spring->modulus;
  // Fourth order: errors of 1e-12 times higher derivatives, and of round-off over the step.
  constexpr double h = 1e-3;
  const auto force = [&](double offset) { return lattice::force(law, 1. + offset); };
  return (8. * (force(h) - force(-h)) - (force(2. * h) - force(-2. * h))) / (12. * h);
}

double absolute_shear_modulus(const lattice::Material &material)
{
  const double lengths[lattice::n_shells] = {1., std::sqrt(3.), 2.}; // over d
  double sum = 0.;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      sum += shell->area_factor * lengths[number] * stiffness_at_rest(shell->law);
  return 3. / 8. * sum;
}

} // namespace latcon::claims
