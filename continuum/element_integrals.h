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
/// Contribution of one cell or face to the functional of eq. (C.28) and its derivatives up to the requested order.
/// Local unknown 2 a + i belongs to scalar shape function a and component i.
struct Contribution
{
  double energy = 0.; ///< [J/m], or dissipated power [W/m]
  std::vector<dealii::types::global_dof_index> dofs;
  dealii::Vector<double> residual;  ///< only with Order::first
  dealii::Vector<double> magnitude; ///< only with Order::first: sums of absolute values
  dealii::FullMatrix<double> tangent;
};

/// Calls add(contribution) for every locally owned cell and every face assigned to this rank, at the state `u` [m]
/// (with ghost entries). Order::second omits the first derivatives. Throws NonPhysicalState, only on the rank where it
/// occurs.
void integrate(const Sheet &sheet, const Sheet::Vector &u, double load_factor, Order order,
               const std::function<void(const Contribution &)> &add);

/// Motion in which a gradient viscosity dissipates.
struct Motion
{
  const GradientViscosity &law;
  const Sheet::Vector &velocity; ///< [m/s], with ghost entries
  double load_rate;              ///< rate of the load factor [1/s]
  double rate_by_displacement;   ///< dv/du [1/s], for Order::second
};

/// Calls add(contribution) likewise for the viscous forces of `motion` at the state `u`, a contribution of which has
/// the dissipated power as energy, the forces as residual and their derivative by u as tangent, which is not symmetric.
/// The sheet must have a gradient law, whose faces and penalty factor these are.
void integrate(const Sheet &sheet, const Sheet::Vector &u, const Motion &motion, Order order,
               const std::function<void(const Contribution &)> &add);

/// Visitor of quadrature points, with the energy of a point: density times weight [J/m], without the stiffness factor.
using PointEnergyVisitor = std::function<void(const dealii::DoFHandler<2>::active_cell_iterator &cell,
                                              const dealii::Point<2> &unit_point, double energy)>;

/// Calls visit(cell, unit_point, energy) for each quadrature point of each locally owned cell and of every face
/// assigned to this rank, at the state `u` [m] (with ghost entries). A point on a face between cells belongs to the
/// finer cell. The energies of a face may be negative. Throws NonPhysicalState, only on the rank where it occurs.
void visit_point_energies(const Sheet &sheet, const Sheet::Vector &u, double load_factor,
                          const PointEnergyVisitor &visit);
} // namespace latcon::continuum
