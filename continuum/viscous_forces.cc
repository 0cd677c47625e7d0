#include "continuum/viscous_forces.h"

#include "continuum/collective.h"
#include "continuum/element_integrals.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
PointForces viscous(const Viscosity &viscosity, const Sheet::Vector &v, const Order order, const double load_rate = 0.,
                    const double rate_by_displacement = 0.)
{
  PointForces forces;
  forces.velocity = &v;
  forces.gradient = viscosity.gradient();
  forces.load_rate = load_rate;
  forces.rate_by_displacement = rate_by_displacement;
  forces.density = [=, &viscosity](const CellPoint &point, PointIntegrand &density)
  {
    const Viscosity &law = viscosity.at(point.X);
    const Tensor<2, 2> F = deformation_gradient(point.u);
    Tensor<2, 2> Fdot;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        Fdot[i][J] = point.v[i][J];
    if (order == Order::value)
      density.value += law.dissipation(F, Fdot);
    if (order == Order::first)
      add_stress(density, law.stress(F, Fdot));
    if (order == Order::second)
      add_tangent(density, law.stress_by_F(F, Fdot) + rate_by_displacement * law.stress_by_rate(F, Fdot));
  };
  return forces;
}
} // namespace

ViscousForces::ViscousForces(const Sheet &sheet, const Viscosity *viscosity) : sheet_(sheet), viscosity_(viscosity)
{
  if (viscosity != nullptr && viscosity->gradient() != nullptr && !sheet.has_gradient())
    throw InvalidInput("a viscosity with a gradient part needs a sheet with a gradient law");
}

void ViscousForces::add_forces(const Vector &u, const Vector &v, const double load_rate, Vector &forces,
                               Vector *magnitude) const
{
  if (viscosity_ != nullptr)
    continuum::add_forces(sheet_, u, viscous(*viscosity_, v, Order::first, load_rate), forces, magnitude);
}

void ViscousForces::add_tangent(const Vector &u, const Vector &v, const double load_rate,
                                const double rate_by_displacement, const AffineConstraints<double> &constraints,
                                Sheet::Matrix &matrix) const
{
  if (viscosity_ != nullptr)
    continuum::add_tangent(sheet_, u, viscous(*viscosity_, v, Order::second, load_rate, rate_by_displacement),
                           constraints, matrix);
}

void ViscousForces::add_stresses(const Vector &u, const Vector &v, std::vector<Tensor<2, 2>> &stresses) const
{
  if (viscosity_ != nullptr)
    continuum::add_stresses(sheet_, u, viscous(*viscosity_, v, Order::first), stresses);
}

double ViscousForces::dissipation(const Vector &u, const Vector &v, const double load_rate) const
{
  if (viscosity_ == nullptr)
    return 0.;
  double own = 0.;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     integrate(sheet_, u, viscous(*viscosity_, v, Order::value, load_rate), Order::value,
                               [&](const Contribution &part) { own += part.energy; });
                   });
  return dealii::Utilities::MPI::sum(own, sheet_.communicator());
}
} // namespace latcon::continuum
