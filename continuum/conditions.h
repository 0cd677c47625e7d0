#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>
#include <deal.II/fe/component_mask.h>

#include <initializer_list>
#include <memory>
#include <optional>
#include <vector>

namespace latcon::continuum
{
/// Vector field with two components over the reference configuration.
using VectorField = std::shared_ptr<const dealii::Function<2>>;

/// Components of a field that is prescribed on one part of the boundary: load factor * field_i(X), a function of the
/// reference position X [m]; in a motion the factor is 1.
struct BoundaryField
{
  dealii::types::boundary_id boundary;
  VectorField field;
  dealii::ComponentMask components = dealii::ComponentMask(); ///< default both
};

/// Dead load on the whole sheet: load factor * (1 - length^2 Laplace) force_i(X) [N/m^3] (theory-continuum.md, eq.
/// (C.32)).
struct BodyForce
{
  VectorField force;  ///< [N/m^3]; must implement its gradient if length > 0
  double length = 0.; ///< l_d [m] >= 0
};

/// Periodicity of two opposite straight edges: u(second) - u(first) keeps its initial value. The mesh must be periodic
/// as well (see make_rectangle).
struct PeriodicPair
{
  dealii::types::boundary_id first;
  dealii::types::boundary_id second;
  unsigned int direction; ///< 0: x, 1: y
};

/// Boundary conditions and loads of a sheet. An edge without any condition is free of traction and of double traction.
struct BoundaryConditions
{
  BoundaryConditions() = default;
  BoundaryConditions(std::vector<BoundaryField> held) : displacements(std::move(held)) {}
  BoundaryConditions(std::initializer_list<BoundaryField> held) : displacements(held) {}

  std::vector<BoundaryField> displacements; ///< u_i [m]
  /// N_J du_i/dX_J [-], weakly, with the outward reference normal N; they require a gradient law. On a plane of
  /// symmetry, the component along the plane is prescribed as zero.
  std::vector<BoundaryField> normal_gradients;
  /// Dead loads [Pa], force per reference length and thickness; with a gradient law those conjugate to the displacement
  /// of the edge, eq. (C.31).
  std::vector<BoundaryField> tractions;
  /// Dead double tractions [Pa m], conjugate to the normal gradient of displacement; they require a gradient law.
  std::vector<BoundaryField> double_tractions;
  std::optional<BodyForce> body_force;
  std::vector<PeriodicPair> periodic;
};
} // namespace latcon::continuum
