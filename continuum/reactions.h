#pragma once

#include "continuum/sheet.h"

#include <deal.II/fe/component_mask.h>

#include <map>

namespace latcon::continuum
{
/// Forces [N/m] that boundaries exert on the sheet in the state `u` (nodal displacement [m], with ghost entries) at
/// `load_factor` [-], per unit reference thickness: sums of the nodal residuals, dead loads taken off, of the unknowns
/// that each boundary holds, so that over all boundaries they add up to the sum of the nodal reactions exactly. `held`
/// says which components each boundary id holds.
///
/// A node that several boundaries hold has one residual and no unique share: each gets the integral of its own traction
/// P N against the shape function, and the rest, which vanishes under refinement, is shared equally
/// (theory-continuum.md, eq. (C.18)).
/// Collective. Throws NonPhysicalState on every rank if the state is non-physical.
std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>>
boundary_reactions(const Sheet &sheet, const Sheet::Vector &u, double load_factor,
                   const std::map<dealii::types::boundary_id, dealii::ComponentMask> &held);
} // namespace latcon::continuum
