#pragma once

// Nodal forces and tangents of stresses at quadrature points; private to the forces of viscosity and memory.

#include "continuum/sheet.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <cmath>
#include <vector>

namespace latcon::continuum::stress_integrals
{
/// Quadrature points of one cell.
template <std::size_t n_fields>
struct CellPoints
{
  std::size_t cell;                  ///< number among the locally owned cells
  const dealii::FEValues<2> &values; ///< with gradients and weights
  /// Gradients of the nodal fields, per quadrature point.
  std::array<std::vector<dealii::Tensor<2, 2>>, n_fields> gradients;
  std::vector<dealii::types::global_dof_index> dofs;
};

/// Calls work(points) for every locally owned cell, at the points of the elastic energy. The nodal vectors have ghost
/// entries. Local.
template <std::size_t n_fields, class Work>
void for_each_cell(const Sheet &sheet, const std::array<const Sheet::Vector *, n_fields> &fields, const Work &work)
{
  dealii::FEValues<2> values(sheet.mapping(), sheet.element(), dealii::QGauss<2>(sheet.degree() + 1),
                             dealii::update_gradients | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector displacement(0);
  CellPoints<n_fields> points{0, values, {}, {}};
  for (auto &gradients : points.gradients)
    gradients.resize(values.n_quadrature_points);
  points.dofs.resize(sheet.element().n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      for (std::size_t f = 0; f < n_fields; ++f)
        values[displacement].get_function_gradients(*fields[f], points.gradients[f]);
      cell->get_dof_indices(points.dofs);
      work(points);
      ++points.cell;
    }
}

/// Adds the unit tensor to the gradients of a displacement.
inline void add_identity(std::vector<dealii::Tensor<2, 2>> &gradients)
{
  for (dealii::Tensor<2, 2> &F : gradients)
    for (unsigned int i = 0; i < 2; ++i)
      F[i][i] += 1.;
}

/// Adds the integral of P : Grad phi_a over the cell to `local`, and that of the absolute values of its terms to
/// `local_magnitude`, for the first Piola stress P at the quadrature point q.
inline void add_stress(const dealii::FEValues<2> &values, const unsigned int q, const dealii::Tensor<2, 2> &P,
                       dealii::Vector<double> &local, dealii::Vector<double> &local_magnitude)
{
  for (unsigned int a = 0; a < local.size(); ++a)
    for (unsigned int J = 0; J < 2; ++J)
    {
      const double term =
        P[values.get_fe().system_to_component_index(a).first][J] * values.shape_grad(a, q)[J] * values.JxW(q);
      local[a] += term;
      local_magnitude[a] += std::abs(term);
    }
}

/// Adds the integral of Grad phi_a : T : Grad phi_b over the cell to `local` for the tangent T = dP/dF at the
/// quadrature point q.
inline void add_stiffness(const dealii::FEValues<2> &values, const unsigned int q, const dealii::Tensor<4, 2> &T,
                          dealii::FullMatrix<double> &local)
{
  const dealii::FiniteElement<2> &element = values.get_fe();
  for (unsigned int b = 0; b < local.n(); ++b)
  {
    const unsigned int k = element.system_to_component_index(b).first;
    dealii::Tensor<2, 2> change; // of the stress with unknown b
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        change[i][J] = T[i][J][k] * values.shape_grad(b, q) * values.JxW(q);
    for (unsigned int a = 0; a < local.m(); ++a)
      local(a, b) += change[element.system_to_component_index(a).first] * values.shape_grad(a, q);
  }
}
} // namespace latcon::continuum::stress_integrals
