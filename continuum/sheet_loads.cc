// Integrals of Sheet that do not depend on the state: dead loads, mass.
#include "continuum/collective.h"
#include "continuum/sheet.h"
#include "continuum/single_precision_matrix.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/filtered_iterator.h>

#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
Sheet::Vector Sheet::loads() const
{
  Vector forces = make_owned();
  const DeferredException guarded(
    [&]
    {
      const UpdateFlags needed = update_values | update_gradients | update_quadrature_points | update_JxW_values;
      FEValues<2> values(mapping_, element_, QGauss<2>(degree_ + 2), needed);
      FEFaceValues<2> face_values(mapping_, element_, QGauss<1>(degree_ + 2), needed | update_normal_vectors);
      const unsigned int n = element_.n_dofs_per_cell();
      dealii::Vector<double> local(n);
      std::vector<types::global_dof_index> dofs(n);
      // Adds the work of forces on component i of the displacement and on its gradient.
      const auto add = [&](const FEValuesBase<2> &at, const unsigned int q, const unsigned int i, const double on_value,
                           const Tensor<1, 2> &on_gradient)
      {
        for (unsigned int a = 0; a < n; ++a)
          if (element_.system_to_component_index(a).first == i)
            local[a] += (on_value * at.shape_value(a, q) + on_gradient * at.shape_grad(a, q)) * at.JxW(q);
      };
      for (const auto &cell : dof_handler_.active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
      {
        local = 0.;
        if (conditions_.body_force)
        {
          const auto &[force, length] = *conditions_.body_force;
          values.reinit(cell);
          for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
            for (unsigned int i = 0; i < 2; ++i)
            {
              // (1 - l^2 Laplace) f times a shape function, integrated by parts once.
              Tensor<1, 2> slope;
              if (length > 0.)
                slope = length * length * force->gradient(values.quadrature_point(q), i);
              add(values, q, i, force->value(values.quadrature_point(q), i), slope);
            }
        }
        for (const unsigned int face : cell->face_indices())
        {
          if (!cell->at_boundary(face) || cell->has_periodic_neighbor(face))
            continue;
          const types::boundary_id id = cell->face(face)->boundary_id();
          face_values.reinit(cell, face);
          for (unsigned int q = 0; q < face_values.n_quadrature_points; ++q)
          {
            const Point<2> &X = face_values.quadrature_point(q);
            const Tensor<1, 2> &N = face_values.normal_vector(q);
            for (unsigned int i = 0; i < 2; ++i)
            {
              double on_value = 0.;
              double on_normal_gradient = 0.;
              for (const auto &[boundary, traction, components] : conditions_.tractions)
                if (boundary == id && components[i])
                  on_value += traction->value(X, i);
              for (const auto &[boundary, traction, components] : conditions_.double_tractions)
                if (boundary == id && components[i])
                  on_normal_gradient += traction->value(X, i);
              if (conditions_.body_force && conditions_.body_force->length > 0.)
                on_value -=
                  std::pow(conditions_.body_force->length, 2) * (conditions_.body_force->force->gradient(X, i) * N);
              add(face_values, q, i, on_value, on_normal_gradient * N);
            }
          }
        }
        cell->get_dof_indices(dofs);
        conformity_constraints_.distribute_local_to_global(local, dofs, forces);
      }
    });
  forces.compress(VectorOperation::add);
  guarded.rethrow_collectively(communicator());
  return forces;
}

template <class AnyMatrix>
void Sheet::add_mass(const double density, const double inertia_length, const AffineConstraints<double> &constraints,
                     AnyMatrix &M) const
{
  FEValues<2> values(mapping_, element_, QGauss<2>(degree_ + 1), update_values | update_gradients | update_JxW_values);
  const unsigned int n = element_.n_dofs_per_cell();
  FullMatrix<double> local(n, n);
  std::vector<types::global_dof_index> cell_dofs(n);
  std::vector<types::global_dof_index> dofs(n); // by node and component
  for (const auto &cell : dof_handler_.active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
  {
    values.reinit(cell);
    cell->get_dof_indices(cell_dofs);
    local = 0.;
    for (unsigned int a = 0; a < n / 2; ++a)
      for (unsigned int i = 0; i < 2; ++i)
      {
        const unsigned int row = element_.component_to_system_index(i, a);
        dofs[2 * a + i] = cell_dofs[row];
        for (unsigned int b = 0; b < n / 2; ++b)
        {
          const unsigned int column = element_.component_to_system_index(i, b);
          for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
            local(2 * a + i, 2 * b + i) +=
              density *
              (values.shape_value(row, q) * values.shape_value(column, q) +
               inertia_length * inertia_length * (values.shape_grad(row, q) * values.shape_grad(column, q))) *
              values.JxW(q);
        }
      }
    constraints.distribute_local_to_global(local, dofs, M);
  }
  M.compress(VectorOperation::add);
}

template void Sheet::add_mass(double, double, const AffineConstraints<double> &, Matrix &) const;
template void Sheet::add_mass(double, double, const AffineConstraints<double> &, SinglePrecisionMatrix &) const;
} // namespace latcon::continuum
