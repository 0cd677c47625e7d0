#pragma once

#include "continuum/sheet.h"

#include <deal.II/lac/vector.h>

namespace latcon::continuum
{
/// Computes for each active cell an indicator eta_K^2 [J/m] of its contribution to the squared error in the energy
/// norm: half of the sum over its faces of
///   h/(2 p mu) |[P] N|^2 + (gamma p (p+1)/h) c |[dN u]|^2 + (h/c) |[Q N N]|^2
/// over the jumps [.] between cells, mu the shear modulus of the local law at F = I and c the normal stiffness of the
/// gradient law, whose two terms are absent without one (theory-continuum.md, eq. (C.33)). It serves to select cells
/// for refinement and is not a bound. Entries of cells of other ranks are zero. `u` is the nodal displacement [m] with
/// ghost entries. Collective. Throws NonPhysicalState on every rank.
dealii::Vector<float> error_indicators(const Sheet &sheet, const Sheet::Vector &u);
} // namespace latcon::continuum
