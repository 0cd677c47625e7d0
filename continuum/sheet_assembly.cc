// Integrals of Sheet that depend on the state: energy, residual, tangent.
#include "continuum/element_integrals.h"
#include "continuum/sheet.h"
#include "continuum/single_precision_matrix.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <limits>

using namespace dealii;

namespace latcon::continuum
{
double Sheet::energy(const Vector &u, const double load_factor) const
{
  return integral(*this, u, energy_densities(*this, load_factor, Order::value));
}

double Sheet::residual(const Vector &u, Vector &r, Vector &magnitude, const double load_factor) const
{
  r = 0.;
  magnitude = 0.;
  return add_forces(*this, u, energy_densities(*this, load_factor, Order::first), r, &magnitude);
}

template <class AnyMatrix>
void Sheet::tangent(const Vector &u, const AffineConstraints<double> &constraints, AnyMatrix &K,
                    const double load_factor, const Vector *lift, Vector *stiffness_times_lift) const
{
  K = 0.;
  if (lift != nullptr)
    *stiffness_times_lift = 0.;
  add_tangent(*this, u, energy_densities(*this, load_factor, Order::second), constraints, K, lift,
              stiffness_times_lift);
}

template void Sheet::tangent(const Vector &, const AffineConstraints<double> &, Matrix &, double, const Vector *,
                             Vector *) const;
template void Sheet::tangent(const Vector &, const AffineConstraints<double> &, SinglePrecisionMatrix &, double,
                             const Vector *, Vector *) const;

void Sheet::make_matrix(const AffineConstraints<double> &constraints, Matrix &matrix, const bool is_mass) const
{
  TrilinosWrappers::SparsityPattern pattern(owned_, owned_, constraints.get_local_lines(), communicator());
  const types::subdomain_id own = dealii::Utilities::MPI::this_mpi_process(communicator());
  if (has_gradient() && !is_mass)
    DoFTools::make_flux_sparsity_pattern(dof_handler_, pattern, constraints, false, own);
  else
    DoFTools::make_sparsity_pattern(dof_handler_, pattern, constraints, false, own);
  pattern.compress();
  matrix.reinit(pattern);
}

DeterminantRange Sheet::determinant_range(const Vector &u) const
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  PointForces at_points;
  at_points.local = [&](const CellPoint &point, PointIntegrand &)
  {
    const double J = determinant(deformation_gradient(point.u));
    smallest = std::min(smallest, J);
    largest = std::max(largest, J);
  };
  integrate(*this, u, at_points, Order::value, [](const Contribution &) {});
  return {dealii::Utilities::MPI::min(smallest, communicator()), dealii::Utilities::MPI::max(largest, communicator())};
}
} // namespace latcon::continuum
