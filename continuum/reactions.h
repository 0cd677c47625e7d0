#pragma once

#include "continuum/sheet.h"

#include <map>

namespace latcon::continuum
{
/// Returns the force [N/m] that each boundary exerts on the sheet in the state `u` (nodal displacement [m], with ghost
/// entries), per unit reference thickness. A force is the sum of the `residual` (nodal residuals minus dead loads
/// [N/m]) over the unknowns held at the boundary, so the forces add up exactly to the sum of the nodal reactions.
///
/// The residual of a node on several held boundaries is divided between them: each gets the integral of its own
/// traction P N times the shape function, and an equal part of the remainder, which vanishes under refinement
/// (theory-continuum.md, eq. (C.18)). Collective. Throws NonPhysicalState on every rank if the state is non-physical.
std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>>
boundary_reactions(const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector &residual);
} // namespace latcon::continuum
