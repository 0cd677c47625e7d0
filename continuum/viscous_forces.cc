#include "continuum/viscous_forces.h"

#include "continuum/collective.h"
#include "continuum/element_integrals.h"
#include "continuum/errors.h"
#include "continuum/stress_integrals.h"

#include <deal.II/base/mpi.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Calls work(points, F, Fdot) for every locally owned cell; u and v have ghost entries. Local.
template <typename Work>
void for_each_cell(const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector &v, const Work &work)
{
  stress_integrals::for_each_cell<2>(sheet, {&u, &v},
                                     [&](auto &points)
                                     {
                                       stress_integrals::add_identity(points.gradients[0]);
                                       work(points, points.gradients[0], points.gradients[1]);
                                     });
}
FieldDerivatives field_derivatives(const Tensor<2, 2> &first, const Tensor<3, 2> &second)
{
  FieldDerivatives all;
  for (unsigned int i = 0; i < 2; ++i)
    all[i] = {first[i][0], first[i][1], second[i][0][0], second[i][1][1], second[i][0][1]};
  return all;
}

// Adds the first Piola stresses of the gradient part at the points of the elastic energy. Local.
void add_gradient_stresses(const Sheet &sheet, const GradientViscosity &law, const Sheet::Vector &u,
                           const Sheet::Vector &v, std::vector<Tensor<2, 2>> &stresses)
{
  FEValues<2> values(sheet.mapping(), sheet.element(), QGauss<2>(sheet.degree() + 1),
                     update_gradients | update_hessians);
  std::vector<Tensor<2, 2>> first[2] = {std::vector<Tensor<2, 2>>(values.n_quadrature_points),
                                        std::vector<Tensor<2, 2>>(values.n_quadrature_points)};
  std::vector<Tensor<3, 2>> second[2] = {std::vector<Tensor<3, 2>>(values.n_quadrature_points),
                                         std::vector<Tensor<3, 2>>(values.n_quadrature_points)};
  const FEValuesExtractors::Vector displacement(0);
  std::size_t point = 0;
  PointIntegrand density;
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      for (unsigned int field = 0; field < 2; ++field)
      {
        values[displacement].get_function_gradients(field == 0 ? u : v, first[field]);
        values[displacement].get_function_hessians(field == 0 ? u : v, second[field]);
      }
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q, ++point)
      {
        clear(density, Order::first);
        law.cell_density(field_derivatives(first[0][q], second[0][q]), field_derivatives(first[1][q], second[1][q]),
                         Order::first, 0., density);
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int J = 0; J < 2; ++J)
            stresses[point][i][J] += density.first[i][0][J];
      }
    }
}
} // namespace

ViscousForces::ViscousForces(const Sheet &sheet, const Viscosity *viscosity)
  : sheet_(sheet), viscosity_(viscosity), gradient_(viscosity == nullptr ? nullptr : viscosity->gradient())
{
  if (gradient_ != nullptr && !sheet.has_gradient())
    throw InvalidInput("a viscosity with a gradient part needs a sheet with a gradient law");
}

void ViscousForces::add_forces(const Vector &u, const Vector &v, const double load_rate, Vector &forces,
                               Vector *magnitude) const
{
  if (viscosity_ == nullptr)
    return;
  const DeferredException guarded(
    [&]
    {
      dealii::Vector<double> local(sheet_.element().n_dofs_per_cell());
      dealii::Vector<double> local_magnitude(local.size());
      for_each_cell(
        sheet_, u, v,
        [&](const auto &points, const auto &F, const auto &Fdot)
        {
          local = 0.;
          local_magnitude = 0.;
          for (unsigned int q = 0; q < F.size(); ++q)
            stress_integrals::add_stress(points.values, q, viscosity_->stress(F[q], Fdot[q]), local, local_magnitude);
          sheet_.conformity_constraints().distribute_local_to_global(local, points.dofs, forces);
          if (magnitude != nullptr)
            sheet_.conformity_constraints().distribute_local_to_global(local_magnitude, points.dofs, *magnitude);
        });
      if (gradient_ != nullptr)
        integrate(sheet_, u, Motion{*gradient_, v, load_rate, 0.}, Order::first,
                  [&](const Contribution &part)
                  {
                    sheet_.conformity_constraints().distribute_local_to_global(part.residual, part.dofs, forces);
                    if (magnitude != nullptr)
                      sheet_.conformity_constraints().distribute_local_to_global(part.magnitude, part.dofs, *magnitude);
                  });
    });
  forces.compress(VectorOperation::add);
  if (magnitude != nullptr)
    magnitude->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());
}

void ViscousForces::add_tangent(const Vector &u, const Vector &v, const double load_rate,
                                const double rate_by_displacement, const AffineConstraints<double> &constraints,
                                Sheet::Matrix &matrix) const
{
  if (viscosity_ == nullptr)
    return;
  const DeferredException guarded(
    [&]
    {
      const unsigned int n = sheet_.element().n_dofs_per_cell();
      FullMatrix<double> local(n, n);
      for_each_cell(sheet_, u, v,
                    [&](const auto &points, const auto &F, const auto &Fdot)
                    {
                      local = 0.;
                      for (unsigned int q = 0; q < F.size(); ++q)
                        stress_integrals::add_stiffness(points.values, q,
                                                        viscosity_->stress_by_F(F[q], Fdot[q]) +
                                                          rate_by_displacement *
                                                            viscosity_->stress_by_rate(F[q], Fdot[q]),
                                                        local);
                      constraints.distribute_local_to_global(local, points.dofs, matrix);
                    });
      if (gradient_ != nullptr)
        integrate(sheet_, u, Motion{*gradient_, v, load_rate, rate_by_displacement}, Order::second,
                  [&](const Contribution &part)
                  { constraints.distribute_local_to_global(part.tangent, part.dofs, matrix); });
    });
  matrix.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());
}

void ViscousForces::add_stresses(const Vector &u, const Vector &v, std::vector<Tensor<2, 2>> &stresses) const
{
  if (viscosity_ == nullptr)
    return;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     for_each_cell(sheet_, u, v,
                                   [&](const auto &points, const auto &F, const auto &Fdot)
                                   {
                                     for (unsigned int q = 0; q < F.size(); ++q)
                                       stresses[points.cell * F.size() + q] += viscosity_->stress(F[q], Fdot[q]);
                                   });
                     if (gradient_ != nullptr)
                       add_gradient_stresses(sheet_, *gradient_, u, v, stresses);
                   });
}

double ViscousForces::dissipation(const Vector &u, const Vector &v, const double load_rate) const
{
  if (viscosity_ == nullptr)
    return 0.;
  double own = 0.;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     for_each_cell(sheet_, u, v,
                                   [&](const auto &points, const auto &F, const auto &Fdot)
                                   {
                                     for (unsigned int q = 0; q < F.size(); ++q)
                                       own += viscosity_->dissipation(F[q], Fdot[q]) * points.values.JxW(q);
                                   });
                     if (gradient_ != nullptr)
                       integrate(sheet_, u, Motion{*gradient_, v, load_rate, 0.}, Order::value,
                                 [&](const Contribution &part) { own += part.energy; });
                   });
  return dealii::Utilities::MPI::sum(own, sheet_.communicator());
}
} // namespace latcon::continuum
