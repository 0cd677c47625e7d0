#pragma once

#include "continuum/point_integrand.h"
#include "continuum/sheet.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <vector>

namespace latcon::continuum
{
/// What one cell or face adds to the functional of eq. (C.28) and its derivatives, up to the order asked for. Its
/// unknowns are 2 a + i for scalar shape function a and component i.
struct Contribution
{
  double energy = 0.;
  std::vector<dealii::types::global_dof_index> dofs;
  dealii::Vector<double> residual;  ///< from Order::first alone
  dealii::Vector<double> magnitude; ///< likewise: sums of absolute values
  dealii::FullMatrix<double> tangent;
};

/// Calls add(contribution) for every own cell and for every face that falls to this rank, at the state `u` [m] (with
/// ghost entries). Order::second gives no first derivatives. Throws NonPhysicalState, on the rank where it happens.
void integrate(const Sheet &sheet, const Sheet::Vector &u, double load_factor, Order order,
               const std::function<void(const Contribution &)> &add);
} // namespace latcon::continuum
