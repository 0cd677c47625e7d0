#pragma once

#include <cmath>

#include "lattice/material.h"

namespace latcon::claims
{

/// Returns psi''(1) [Pa] of a bond law, as below.
[[nodiscard]] inline double stiffness_at_rest(const lattice::BondLaw &law)
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

/// Returns the shear modulus mu [Pa] of an undeformed lattice from the constants of its bonds alone: 3/8 of the sum of
/// s (l / d) psi''(1) over its shells, l = d, sqrt(3) d and 2 d, with psi''(1) = 3 (a + b) for Mooney-Rivlin bonds, the
/// modulus for linear ones, and differences of the force for user-defined ones (theory-comparison.md, eq. (H.2)).
/// Nothing of it is shared with the lattice or its homogenisation, so that an error in a cross-section, which both have
/// in common, shows.
[[nodiscard]] inline double absolute_shear_modulus(const lattice::Material &material)
{
  const double lengths[lattice::n_shells] = {1., std::sqrt(3.), 2.}; // over d
  double sum = 0.;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      sum += shell->area_factor * lengths[number] * stiffness_at_rest(shell->law);
  return 3. / 8. * sum;
}

} // namespace latcon::claims
