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
/// A field of two components over the reference configuration.
using VectorField = std::shared_ptr<const dealii::Function<2>>;

/// Displacement given on one part of the boundary: u_i(X) = load factor * displacement_i(X) [m].
struct PrescribedDisplacement
{
  dealii::types::boundary_id boundary;
  VectorField displacement;                                   ///< [m], of reference position [m]
  dealii::ComponentMask components = dealii::ComponentMask(); ///< which of the two are held; default both
};

/// Normal gradient of displacement given on one part of the boundary, weakly: N_J du_i/dX_J = load factor *
/// gradient_i(X) [-], N the outward reference normal. Only a sheet with a gradient law can be held so. On a plane of
/// symmetry it is the component along the plane that is held, at zero.
struct PrescribedNormalGradient
{
  dealii::types::boundary_id boundary;
  VectorField gradient;                                       ///< [-]
  dealii::ComponentMask components = dealii::ComponentMask(); ///< which of the two are held; default both
};

/// Dead load on one part of the boundary: load factor * traction_i(X) [Pa], force per reference length and thickness.
/// With a gradient law it is what works on the displacement along the edge, eq. (C.31).
struct Traction
{
  dealii::types::boundary_id boundary;
  VectorField traction; ///< [Pa]
};

/// Dead double traction: load factor * traction_i(X) [Pa m], which works on the normal gradient of displacement.
struct DoubleTraction
{
  dealii::types::boundary_id boundary;
  VectorField traction; ///< [Pa m]
};

/// Dead load on the whole sheet: load factor * (1 - length^2 Laplace) force_i(X) [N/m^3] (theory-continuum.md, eq.
/// (C.32)).
struct BodyForce
{
  VectorField force;  ///< [N/m^3]; with a length, its gradient is asked for as well
  double length = 0.; ///< l_d [m] >= 0
};

/// Two opposite straight edges whose displacements follow each other, u(second) - u(first) = what it was at the start.
/// The mesh must know of it too (see make_rectangle).
struct PeriodicPair
{
  dealii::types::boundary_id first;
  dealii::types::boundary_id second;
  unsigned int direction; ///< 0: x, 1: y
};

/// Everything that acts on a sheet from outside. An edge without any condition is free of traction and of double
/// traction.
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
