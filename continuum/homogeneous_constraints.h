#pragma once

#include "continuum/sheet.h"

#include <deal.II/fe/component_mask.h>

#include <map>

namespace continuum
{
/// Which components are held at which boundary.
using HeldBoundaries = std::map<dealii::types::boundary_id, dealii::ComponentMask>;

/// Hanging nodes of a sheet, and the components that are `held` at its boundaries at zero, chains resolved and closed.
/// Known for every relevant degree of freedom as its owner knows it: what a rank finds out by itself is short of
/// constraints on the far side of its ghost cells, which operators with face terms couple to. A relevant degree of
/// freedom may thus hang on one that is not: a matrix that is condensed needs to be writable, on each rank, in all rows
/// of get_local_lines(). Collective.
dealii::AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const HeldBoundaries &held);
} // namespace continuum
