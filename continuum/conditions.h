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

/// Prescribed displacement on one part of the boundary: u_i(X) = load factor * displacement_i(X) [m].
struct PrescribedDisplacement
{
  dealii::types::boundary_id boundary;
  VectorField displacement;                                   ///< [m], function of the reference position [m]
  dealii::ComponentMask components = dealii::ComponentMask(); ///< prescribed components; default both
};

/// Weakly prescribed normal gradient of displacement on one part of the boundary: N_J du_i/dX_J = load factor *
/// gradient_i(X) [-], with the outward reference normal N. Requires a gradient law. On a plane of symmetry, the
/// component along the plane is prescribed as zero.
struct PrescribedNormalGradient
{
  dealii::types::boundary_id boundary;
  VectorField gradient;                                       ///< [-]
  dealii::ComponentMask components = dealii::ComponentMask(); ///< prescribed components; default both
};

/// Dead load on one part of the boundary: load factor * traction_i(X) [Pa], force per reference length and thickness.
/// With a gradient law it is the load conjugate to the displacement of the edge, eq. (C.31).
struct Traction
{
  dealii::types::boundary_id boundary;
  VectorField traction; ///< [Pa]
};

/// Dead double traction on one part of the boundary: load factor * traction_i(X) [Pa m], conjugate to the normal
/// gradient of displacement. Requires a gradient law.
struct DoubleTraction
{
  dealii::types::boundary_id boundary;
  VectorField traction; ///< [Pa m]
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
  BoundaryConditions(std::vector<PrescribedDisplacement> held) : displacements(std::move(held)) {}
  BoundaryConditions(std::initializer_list<PrescribedDisplacement> held) : displacements(held) {}

  std::vector<PrescribedDisplacement> displacements;
  std::vector<PrescribedNormalGradient> normal_gradients;
  std::vector<Traction> tractions;
  std::vector<DoubleTraction> double_tractions;
  std::optional<BodyForce> body_force;
  std::vector<PeriodicPair> periodic;
};
} // namespace latcon::continuum
