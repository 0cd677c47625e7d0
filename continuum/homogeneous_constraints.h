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
/// constraints on the far side of its ghost cells, which operators with face terms couple to. A degree of freedom that
/// is relevant may thus hang on one that is not; see writable_rows. Collective.
dealii::AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const HeldBoundaries &held);

/// Rows of a matrix that this rank may have to add to when it condenses by `constraints`: the relevant ones and those
/// they hang on.
dealii::IndexSet writable_rows(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints);
} // namespace continuum
