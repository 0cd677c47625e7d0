#include "continuum/viscous_forces.h"

#include "continuum/collective.h"
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
} // namespace

void ViscousForces::add_forces(const Vector &u, const Vector &v, Vector &forces, Vector *magnitude) const
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
                   });
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
                                   [&](const auto &points, const auto &F, const auto &Fdot)
                                   {
                                     for (unsigned int q = 0; q < F.size(); ++q)
                                       own += viscosity_->dissipation(F[q], Fdot[q]) * points.values.JxW(q);
                                   });
                   });
  return dealii::Utilities::MPI::sum(own, sheet_.communicator());
}
} // namespace latcon::continuum
