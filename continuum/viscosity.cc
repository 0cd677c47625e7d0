#include "continuum/viscosity.h"

#include "continuum/errors.h"
#include "continuum/fibres.h"
#include "continuum/material.h"

#include <cmath>

namespace latcon::continuum
{
FibreViscosity::FibreViscosity(std::vector<FibreDashpot> dashpots, const double gradient_length)
  : dashpots_(std::move(dashpots))
{
  require(!dashpots_.empty(), "fibre viscosity needs at least one dashpot");
  std::vector<StrainMeasure> gradients;
  for (const FibreDashpot &dashpot : dashpots_)
  {
    check_fibre(dashpot.direction, dashpot.weight, "a dashpot");
    if (!(dashpot.viscosity >= 0. && std::isfinite(dashpot.viscosity)))
      throw InvalidInput("the viscosity of a dashpot must be finite and not negative");
    const double weight = dashpot.weight * dashpot.viscosity;
    strains_.push_back(stretch_measure(dashpot.direction, weight));
    if (gradient_length != 0.)
      for (const StrainMeasure &strain : gradient_measures(dashpot.direction, weight, dashpot.length, gradient_length))
        gradients.push_back(strain);
  }
  if (gradient_length == 0.)
    return;
  const auto gradient = std::make_shared<FibreViscosity>(*this);
  gradient->strains_ = std::move(gradients);
  gradient_ = gradient;
}

void FibreViscosity::add_density(const FieldDerivatives &u, const FieldDerivatives &v, const Order order,
                                 const double rate_by_displacement, PointIntegrand &density) const
{
  checked_determinant(deformation_gradient(u));
  for (const StrainMeasure &measure : strains_)
  {
    const FibreStrain strain(measure, u);
    const double rate = strain.rate(v);
    density.value += measure.weight * rate * rate;
    if (order == Order::value)
      continue;
    strain.add_force(measure.weight * rate, density);
    if (order == Order::second)
      strain.add_stiffness(measure.weight * rate,
                           measure.weight * (rate_by_displacement * strain.first() + strain.rate_by_state(v)), density);
  }
}
} // namespace latcon::continuum
