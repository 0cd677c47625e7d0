#pragma once

#include "continuum/damage/gradient_forces.h"

#include <array>
#include <vector>

namespace latcon::continuum
{
/// Returns an upper bound of the eigenvalues of forces over masses of a sheet with gradient energy and micro-inertia,
/// for any damage (theory-damage.md, eq. (C.81)): the unit is that of `conductivity` over density and m^2.
/// @param conductivity entries XX, XY, YY of the stiffness [Pa] or viscosity [Pa s] of the cells against Grad u
/// @param terms of the gradient energy; empty for viscous forces
/// @param length l_d of the micro-inertia [m], 0 without
double patch_bound(const NodeGrid &grid, const std::array<double, 3> &conductivity,
                   const std::vector<GradientForces::PatchTerm> &terms, double density, double length);
} // namespace latcon::continuum
