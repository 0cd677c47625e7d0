#include "continuum/fibre_memory.h"

#include "continuum/errors.h"
#include "continuum/fibres.h"
#include "continuum/material.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace latcon::continuum
{
namespace
{
// Mean of (1 - e^-s)^2 for s from 0 to x: in closed form where it has its digits, otherwise by Gauss quadrature, whose
// error is below 1e-17 for x <= 1.
double mean_squared_rise(const double x)
{
  const double rise = -std::expm1(-x);
  if (x > 1.)
    return (x - rise - 0.5 * rise * rise) / x;
  static const dealii::QGauss<1> points(8);
  double sum = 0.;
  for (unsigned int q = 0; q < points.size(); ++q)
    sum += points.weight(q) * std::pow(std::expm1(-x * points.point(q)[0]), 2);
  return sum;
}
} // namespace

FibreMemory::FibreMemory(std::vector<MaxwellFibres> families, const double gradient_length)
  : families_(std::move(families)), gradient_length_(gradient_length)
{
  require(!families_.empty(), "fibre memory needs at least one family");
  for (const MaxwellFibres &fibres : families_)
  {
    check_fibre(fibres.direction, fibres.weight, "Maxwell branches");
    require(!fibres.branches.empty(), "a family of Maxwell branches needs at least one branch");
    for (const auto &[modulus, time] : fibres.branches)
      require(modulus > 0. && time > 0. && std::isfinite(modulus) && std::isfinite(time),
              "the modulus and the relaxation time of a Maxwell branch must be positive and finite");
    add(stretch_measure(fibres.direction, fibres.weight), fibres);
  }
  if (gradient_length == 0.)
    return;
  const auto gradient = std::make_shared<FibreMemory>(*this);
  gradient->strains_.clear();
  gradient->variables_.clear();
  for (const MaxwellFibres &fibres : families_)
    for (const StrainMeasure &strain :
         gradient_measures(fibres.direction, fibres.weight, fibres.length, gradient_length))
      gradient->add(strain, fibres);
  gradient_ = gradient;
}

void FibreMemory::add(const StrainMeasure &strain, const MaxwellFibres &fibres)
{
  for (std::size_t i = 0; i < fibres.branches.size(); ++i)
    variables_.push_back({strains_.size(), strain.weight, fibres.branches[i], fibres.first_number + i});
  strains_.push_back(strain);
  n_numbers_ = std::max(n_numbers_, fibres.first_number + fibres.branches.size());
}

FibreMemory::Step FibreMemory::step(const double duration) const
{
  Step step;
  for (const Variable &variable : variables_)
  {
    const auto &[modulus, time] = variable.branch;
    const double x = duration / time;
    const double rise = -std::expm1(-x);
    const double mean = x > 0. ? rise / x : 1.;
    const double of_change = x > 0. ? modulus * mean_squared_rise(x) / x : 0.;
    step.push_back({std::exp(-x), modulus * mean, -0.5 * std::expm1(-2. * x) / modulus, rise * mean, of_change});
  }
  return step;
}

void FibreMemory::strains(const FieldDerivatives &u, double *e) const
{
  checked_determinant(deformation_gradient(u));
  for (const StrainMeasure &strain : strains_)
    *e++ = FibreStrain(strain, u).value();
}

void FibreMemory::advance(const Step &step, const double *before, const double *now, double *q) const
{
  for (std::size_t v = 0; v < variables_.size(); ++v)
  {
    const std::size_t e = variables_[v].strain;
    q[v] = step[v].decay * q[v] + step[v].gain * (now[e] - before[e]);
  }
}

void FibreMemory::set_sudden(const std::size_t number, const double *relaxed, const double *now, double *q) const
{
  for (std::size_t v = 0; v < variables_.size(); ++v)
    if (variables_[v].number == number)
      q[v] = variables_[v].branch.modulus * (now[variables_[v].strain] - relaxed[variables_[v].strain]);
}

void FibreMemory::add_stored(const double *q, double *by_number) const
{
  for (std::size_t v = 0; v < variables_.size(); ++v)
    by_number[variables_[v].number] += variables_[v].weight * 0.5 * q[v] * q[v] / variables_[v].branch.modulus;
}

void FibreMemory::add_dissipated(const Step &step, const double *before, const double *now, const double *q,
                                 double *by_number) const
{
  for (std::size_t v = 0; v < variables_.size(); ++v)
  {
    const auto &of_branch = step[v];
    const double change = now[variables_[v].strain] - before[variables_[v].strain];
    by_number[variables_[v].number] +=
      variables_[v].weight * (of_branch.of_squares * q[v] * q[v] + of_branch.of_product * q[v] * change +
                              of_branch.of_change * change * change);
  }
}

void FibreMemory::add_density(const Step &step, const FieldDerivatives &u, const double *q, const Order order,
                              PointIntegrand &density) const
{
  std::size_t v = 0;
  for (std::size_t e = 0; e < strains_.size(); ++e)
  {
    double force = 0., gain = 0.;
    for (; v < variables_.size() && variables_[v].strain == e; ++v)
    {
      force += strains_[e].weight * q[v];
      gain += order == Order::second ? strains_[e].weight * step[v].gain : 0.;
    }
    const FibreStrain strain(strains_[e], u);
    strain.add_force(force, density);
    if (order == Order::second)
      strain.add_stiffness(force, gain * strain.first(), density);
  }
}
} // namespace latcon::continuum
