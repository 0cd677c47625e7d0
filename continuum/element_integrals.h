#pragma once

#include "continuum/gradient_viscosity.h"
#include "continuum/point_integrand.h"
#include "continuum/sheet.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <vector>

namespace latcon::continuum
{
/// Contribution of one cell, or of one of its faces, to the functional of eq. (C.28) and its derivatives up to the
/// requested order. Local unknown 2 a + i belongs to scalar shape function a and component i.
struct Contribution
{
  double energy = 0.; ///< [J/m], or dissipated power [W/m]
  std::vector<dealii::types::global_dof_index> dofs;
  dealii::Vector<double> residual;  ///< only with Order::first
  dealii::Vector<double> magnitude; ///< only with Order::first: sums of absolute values
  dealii::FullMatrix<double> tangent;
};

/// Calls add(contribution) for every locally owned cell and, with a gradient law, each of its lifted faces, at the
/// state `u` [m] (with ghost entries). Order::second omits the first derivatives. Throws NonPhysicalState, only on the
/// rank where it occurs.
void integrate(const Sheet &sheet, const Sheet::Vector &u, double load_factor, Order order,
               const std::function<void(const Contribution &)> &add);

/// Quadrature point of a cell.
struct CellPoint
{
  std::size_t number; ///< among the points of the cells on this rank, in their order
  dealii::Point<2> X; ///< reference position [m]
  double JxW;         ///< weight [m^2]
  const FieldDerivatives &u; ///< of the displacement, by reference position
  const FieldDerivatives &v; ///< of the velocity, likewise; undefined without one
};

/// Forces that no energy of u gives, those of viscosity and memory.
struct PointForces
{
  /// Adds the density at a point: dissipated power [W/m^3] as `value`, stresses as `first`, their derivatives by u as
  /// `second`. The density has been cleared.
  std::function<void(const CellPoint &, PointIntegrand &)> density;
  bool is_symmetric = false;                   ///< whether that derivative is symmetric
  const Sheet::Vector *velocity = nullptr;     ///< [m/s], with ghost entries; nullptr: none
  const GradientViscosity *gradient = nullptr; ///< law of the lifted gradients of u and v; nullptr: none
  double load_rate = 0.;                       ///< rate of the load factor [1/s], for prescribed normal gradients
  double rate_by_displacement = 0.;            ///< dv/du [1/s], for `gradient` and Order::second
};

/// Calls add(contribution) likewise for `forces` at the state `u`: dissipated power as energy, forces as residual,
/// their derivative by u as tangent. With `gradient` the sheet must have a gradient law.
void integrate(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Order order,
               const std::function<void(const Contribution &)> &add);

/// Adds nodal forces [N/m] to `nodal` and, if given, the absolute values of their terms to `magnitude`. As all functions
/// below, collective; throws NonPhysicalState on every rank.
void add_forces(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Sheet::Vector &nodal,
                Sheet::Vector *magnitude);

/// Adds the derivative of the nodal forces by u [N/m^2] to `matrix`, condensed by `constraints`.
void add_tangent(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces,
                 const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &matrix);

/// Calls visit(point) for every quadrature point of the cells on this rank.
void for_each_point(const Sheet &sheet, const Sheet::Vector &u, const std::function<void(const CellPoint &)> &visit);

/// Adds the first Piola stresses [Pa] at the quadrature points of the cells on this rank, in their order.
void add_stresses(const Sheet &sheet, const Sheet::Vector &u, PointForces forces,
                  std::vector<dealii::Tensor<2, 2>> &stresses);
} // namespace latcon::continuum
