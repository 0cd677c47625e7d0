#include "continuum/viscous_forces.h"

#include "continuum/collective.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Calls work(values, F, Fdot, dofs) for every locally owned cell; u and v have ghost entries. Local.
template <typename Work>
void for_each_cell(const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector &v, const Work &work)
{
  FEValues<2> values(sheet.mapping(), sheet.element(), QGauss<2>(sheet.degree() + 1),
                     update_gradients | update_JxW_values);
  const FEValuesExtractors::Vector field(0);
  std::vector<Tensor<2, 2>> F(values.n_quadrature_points);
  std::vector<Tensor<2, 2>> Fdot(values.n_quadrature_points);
  std::vector<types::global_dof_index> dofs(sheet.element().n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      values[field].get_function_gradients(u, F);
      values[field].get_function_gradients(v, Fdot);
      for (Tensor<2, 2> &at_point : F)
        for (unsigned int i = 0; i < 2; ++i)
          at_point[i][i] += 1.;
      cell->get_dof_indices(dofs);
      work(values, F, Fdot, dofs);
    }
}
} // namespace

void ViscousForces::add_forces(const Vector &u, const Vector &v, Vector &forces, Vector *magnitude) const
{
  if (viscosity_ == nullptr)
    return;
  const DeferredException guarded(
    [&]
    {
      const auto &element = sheet_.element();
      dealii::Vector<double> local(element.n_dofs_per_cell());
      dealii::Vector<double> local_magnitude(element.n_dofs_per_cell());
      for_each_cell(sheet_, u, v,
                    [&](const auto &values, const auto &F, const auto &Fdot, const auto &dofs)
                    {
                      local = 0.;
                      local_magnitude = 0.;
                      for (unsigned int q = 0; q < F.size(); ++q)
                      {
                        const Tensor<2, 2> P = viscosity_->stress(F[q], Fdot[q]);
                        for (unsigned int a = 0; a < dofs.size(); ++a)
                          for (unsigned int J = 0; J < 2; ++J)
                          {
                            const double term = P[element.system_to_component_index(a).first][J] *
                                                values.shape_grad(a, q)[J] * values.JxW(q);
                            local[a] += term;
                            local_magnitude[a] += std::abs(term);
                          }
                      }
                      sheet_.conformity_constraints().distribute_local_to_global(local, dofs, forces);
                      if (magnitude != nullptr)
                        sheet_.conformity_constraints().distribute_local_to_global(local_magnitude, dofs, *magnitude);
                    });
    });
  forces.compress(VectorOperation::add);
  if (magnitude != nullptr)
    magnitude->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());
}

void ViscousForces::add_tangent(const Vector &u, const Vector &v, const double rate_by_displacement,
                                const AffineConstraints<double> &constraints, Sheet::Matrix &matrix) const
{
  if (viscosity_ == nullptr)
    return;
  const DeferredException guarded(
    [&]
    {
      const auto &element = sheet_.element();
      const unsigned int n = element.n_dofs_per_cell();
      FullMatrix<double> local(n, n);
      for_each_cell(sheet_, u, v,
                    [&](const auto &values, const auto &F, const auto &Fdot, const auto &dofs)
                    {
                      local = 0.;
                      for (unsigned int q = 0; q < F.size(); ++q)
                      {
                        const Tensor<4, 2> T = viscosity_->stress_by_F(F[q], Fdot[q]) +
                                               rate_by_displacement * viscosity_->stress_by_rate(F[q], Fdot[q]);
                        for (unsigned int b = 0; b < n; ++b)
                        {
                          const unsigned int k = element.system_to_component_index(b).first;
                          Tensor<2, 2> change; // of the stress with unknown b
                          for (unsigned int i = 0; i < 2; ++i)
                            for (unsigned int J = 0; J < 2; ++J)
                              change[i][J] = T[i][J][k] * values.shape_grad(b, q) * values.JxW(q);
                          for (unsigned int a = 0; a < n; ++a)
                            local(a, b) += change[element.system_to_component_index(a).first] * values.shape_grad(a, q);
                        }
                      }
                      constraints.distribute_local_to_global(local, dofs, matrix);
                    });
    });
  matrix.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());
}

double ViscousForces::dissipation(const Vector &u, const Vector &v) const
{
  if (viscosity_ == nullptr)
    return 0.;
  double own = 0.;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     for_each_cell(sheet_, u, v,
                                   [&](const auto &values, const auto &F, const auto &Fdot, const auto &)
                                   {
                                     for (unsigned int q = 0; q < F.size(); ++q)
                                       own += viscosity_->dissipation(F[q], Fdot[q]) * values.JxW(q);
                                   });
                   });
  return Utilities::MPI::sum(own, sheet_.communicator());
}
} // namespace latcon::continuum
