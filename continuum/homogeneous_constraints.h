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

/// Which components are held at which boundary.
using DirichletBoundaries = std::map<dealii::types::boundary_id, dealii::ComponentMask>;

/// What prescribed displacements hold.
DirichletBoundaries dirichlet_boundaries(const BoundaryConditions &conditions);

/// The closed constraints of every relevant degree of freedom as its owner knows them. `known` is what this rank found
/// out by itself, which is short of constraints on the far side of its ghost cells; operators with face terms couple to
/// those. A relevant degree of freedom may thus hang on one that is not: a matrix that is condensed needs to be
/// writable, on each rank, in all rows of get_local_lines(). Inhomogeneities are dropped. Collective.
dealii::AffineConstraints<double> shared_constraints(const dealii::AffineConstraints<double> &known,
                                                     const dealii::IndexSet &owned, const dealii::IndexSet &relevant,
                                                     MPI_Comm communicator);

/// What makes the displacement one field (Sheet::conformity_constraints), and the components that are `held` at its
/// boundaries at zero, chains resolved and closed. Shared as above. Collective.
dealii::AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const DirichletBoundaries &held);
} // namespace latcon::continuum
