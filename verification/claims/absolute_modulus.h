#pragma once

#include "lattice/material.h"

namespace latcon::claims
{

/// Returns the shear modulus mu [Pa] of an undeformed lattice from the constants of its bonds alone: 3/8 of the sum of
/// s (l / d) psi''(1) over its shells, l = d, sqrt(3) d and 2 d, with psi''(1) = 3 (a + b) for Mooney-Rivlin bonds, the
/// modulus for linear ones, and differences of the force for user-defined ones (theory-comparison.md, eq. (H.2)).
/// Nothing of it is shared with the lattice or its homogenisation, so that an error in a cross-section, which both have
/// in common, shows.
[[nodiscard]] double absolute_shear_modulus(const lattice::Material &material);

/// Returns psi''(1) [Pa] of a bond law, as above.
[[nodiscard]] double stiffness_at_rest(const lattice::BondLaw &law);

} // namespace latcon::claims
