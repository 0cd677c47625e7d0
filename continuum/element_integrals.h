#pragma once

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

/// Quadrature point of a cell, at which the derivatives of the fields are those in the cell or, once for each lifted
/// face of the cell, those lifted from there, eq. (C.63).
struct CellPoint
{
  std::size_t number;         ///< among the points at which a density is evaluated on this rank, in their order
  std::size_t number_in_cell; ///< among the quadrature points of the cells on this rank, in their order
  double share;               ///< one over the number of times that the density is evaluated here
  dealii::Point<2> X;         ///< reference position [m]
  double JxW;                 ///< weight, times `share` [m^2]
  const FieldDerivatives &u;  ///< of the displacement, by reference position
  const FieldDerivatives &v;  ///< of the velocity, likewise; undefined without one
};

/// Densities at the points of a sheet whose derivatives are forces: those of the energy, or of viscosity and memory.
struct PointForces
{
  /// Adds the density at a point: energy [J/m^3] or dissipated power [W/m^3] as `value`, stresses as `first`, their
  /// derivatives by u as `second`.
  using Density = std::function<void(const CellPoint &, PointIntegrand &)>;

  Density local;                           ///< of the first derivatives
  Density gradient;                        ///< of the lifted second ones, for a sheet with a gradient law; empty: none
  bool is_symmetric = false;               ///< whether the derivative of the stresses is symmetric
  bool has_penalty = false;                ///< whether jumps of the normal derivative are penalised, eq. (C.28)
  const Sheet::Vector *velocity = nullptr; ///< [m/s], with ghost entries; nullptr: none
  double load_factor = 1.;                 ///< of prescribed normal gradients, whose rate is zero [-]
};

/// Returns the densities of the stored energy up to an order, eq. (C.28). `sheet` must outlive them.
PointForces energy_densities(const Sheet &sheet, double load_factor, Order order);

/// Calls add(contribution) for every locally owned cell and, with a gradient density, each of its lifted faces, at the
/// state `u` [m] (with ghost entries): energy or dissipated power, forces as residual, their derivative by u as
/// tangent. Order::second omits the forces. Throws NonPhysicalState, only on the rank where it occurs.
void integrate(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Order order,
               const std::function<void(const Contribution &)> &add);

/// Adds nodal forces [N/m] to `nodal` and, if given, the absolute values of their terms to `magnitude`. Returns the
/// integral of the value of the densities. As all functions below, collective; throws NonPhysicalState on every rank.
double add_forces(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Sheet::Vector &nodal,
                  Sheet::Vector *magnitude);

/// Adds the derivative of the nodal forces by u [N/m^2] to `matrix`, condensed by `constraints`. If `lift` g [m] is
/// given, also adds its product with the uncondensed derivative to `product` [N/m].
/// @tparam AnyMatrix Sheet::Matrix or SinglePrecisionMatrix
template <class AnyMatrix>
void add_tangent(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces,
                 const dealii::AffineConstraints<double> &constraints, AnyMatrix &matrix,
                 const Sheet::Vector *lift = nullptr, Sheet::Vector *product = nullptr);

/// Returns the integral of the value of the densities over the sheet [J/m] or [W/m], which calls them at all points.
double integral(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces);

/// Adds the first Piola stresses [Pa] at the quadrature points of the cells on this rank, in their order; those of
/// lifted gradients are means over the faces of a cell.
void add_stresses(const Sheet &sheet, const Sheet::Vector &u, PointForces forces,
                  std::vector<dealii::Tensor<2, 2>> &stresses);
} // namespace latcon::continuum
