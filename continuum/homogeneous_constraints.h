#pragma once

#include "continuum/conditions.h"

#include <deal.II/base/index_set.h>
#include <deal.II/base/types.h>
#include <deal.II/fe/component_mask.h>
#include <deal.II/lac/affine_constraints.h>

#include <map>

namespace latcon::continuum
{
class Sheet;

/// Components with prescribed displacement, by boundary id.
using DirichletBoundaries = std::map<dealii::types::boundary_id, dealii::ComponentMask>;

/// Returns the boundaries and components on which `conditions` prescribe the displacement.
DirichletBoundaries dirichlet_boundaries(const BoundaryConditions &conditions);

/// Returns the closed constraints of every relevant degree of freedom as known to its owner. The constraints `known` to
/// this rank lack those on the far side of its ghost cells, to which operators with face terms couple. A relevant
/// degree of freedom may depend on one that is not relevant, so each rank must be able to write to all rows of
/// get_local_lines() of a condensed matrix. Inhomogeneities are dropped. Collective.
dealii::AffineConstraints<double> shared_constraints(const dealii::AffineConstraints<double> &known,
                                                     const dealii::IndexSet &owned, const dealii::IndexSet &relevant,
                                                     MPI_Comm communicator);

/// Returns Sheet::conformity_constraints together with zero constraints for the components `held` at boundaries, closed
/// and exchanged between ranks as in shared_constraints(). Collective.
dealii::AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const DirichletBoundaries &held);
} // namespace latcon::continuum
