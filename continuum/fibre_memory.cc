#include "continuum/fibre_memory.h"

#include "continuum/errors.h"
#include "continuum/material.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// (1 - e^-x) / x.
double mean_decay(const double x)
{
  return x > 0. ? -std::expm1(-x) / x : 1.;
}

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

double sum_of(const double *q, const std::size_t n)
{
  double sum = 0.;
  for (std::size_t i = 0; i < n; ++i)
    sum += q[i];
  return sum;
}
} // namespace

void check(const MaxwellFibres &fibres)
{
  const auto is_positive = [](const double x) { return x > 0. && std::isfinite(x); };
  if (!(std::abs(fibres.direction.norm() - 1.) <= 1e-12))
    throw InvalidMaterial("the direction of Maxwell branches must be a unit vector");
  if (!is_positive(fibres.weight))
    throw InvalidMaterial("the weight of Maxwell branches must be positive and finite");
  if (fibres.branches.empty())
    throw InvalidMaterial("a family of Maxwell branches needs at least one branch");
  for (const MaxwellBranch &branch : fibres.branches)
    if (!is_positive(branch.modulus) || !is_positive(branch.relaxation_time))
      throw InvalidMaterial("the modulus and the relaxation time of a Maxwell branch must be positive and finite");
}

FibreMemory::FibreMemory(std::vector<MaxwellFibres> families) : families_(std::move(families))
{
  if (families_.empty())
    throw InvalidMaterial("fibre memory needs at least one family");
  for (const MaxwellFibres &fibres : families_)
  {
    check(fibres);
    n_variables_ += fibres.branches.size();
    n_numbers_ = std::max(n_numbers_, fibres.first_number + fibres.branches.size());
  }
}

FibreMemory::Step FibreMemory::step(const double duration) const
{
  Step step;
  for (const MaxwellFibres &fibres : families_)
    for (const auto &[modulus, time] : fibres.branches)
    {
      const double x = duration / time;
      const double rise = -std::expm1(-x);
      const double mean = mean_decay(x);
      const double of_change = x > 0. ? modulus * mean_squared_rise(x) / x : 0.;
      step.coefficients.push_back(
        {std::exp(-x), modulus * mean, -0.5 * std::expm1(-2. * x) / modulus, rise * mean, of_change});
    }
  return step;
}

void FibreMemory::stretches(const Tensor<2, 2> &F, double *l) const
{
  checked_determinant(F);
  for (const MaxwellFibres &fibres : families_)
    *l++ = (F * fibres.direction).norm();
}

void FibreMemory::advance(const Step &step, const double *before, const double *now, double *q) const
{
  auto of_branch = step.coefficients.begin();
  for (const MaxwellFibres &fibres : families_)
  {
    const double change = *now++ - *before++;
    for (std::size_t i = 0; i < fibres.branches.size(); ++i, ++q, ++of_branch)
      *q = of_branch->decay * *q + of_branch->gain * change;
  }
}

void FibreMemory::add_stored(const double *q, double *by_number) const
{
  for (const MaxwellFibres &fibres : families_)
    for (std::size_t i = 0; i < fibres.branches.size(); ++i, ++q)
      by_number[fibres.first_number + i] += fibres.weight * 0.5 * *q * *q / fibres.branches[i].modulus;
}

void FibreMemory::add_dissipated(const Step &step, const double *before, const double *now, const double *q,
                                 double *by_number) const
{
  auto of_branch = step.coefficients.begin();
  for (const MaxwellFibres &fibres : families_)
  {
    const double change = *now++ - *before++;
    for (std::size_t i = 0; i < fibres.branches.size(); ++i, ++q, ++of_branch)
      by_number[fibres.first_number + i] +=
        fibres.weight * (of_branch->of_squares * *q * *q + of_branch->of_product * *q * change +
                         of_branch->of_change * change * change);
  }
}

Tensor<2, 2> FibreMemory::stress(const Tensor<2, 2> &F, const double *q) const
{
  Tensor<2, 2> P;
  for (const MaxwellFibres &fibres : families_)
  {
    const Tensor<1, 2> f = F * fibres.direction;
    P += fibres.weight * sum_of(q, fibres.branches.size()) / f.norm() * outer_product(f, fibres.direction);
    q += fibres.branches.size();
  }
  return P;
}

Tensor<4, 2> FibreMemory::tangent(const Step &step, const Tensor<2, 2> &F, const double *q) const
{
  Tensor<4, 2> T;
  auto of_branch = step.coefficients.begin();
  for (const MaxwellFibres &fibres : families_)
  {
    const Tensor<1, 2> &N = fibres.direction;
    const Tensor<1, 2> f = F * N;
    const double l = f.norm();
    const Tensor<1, 2> n = f / l;
    const double overstress = sum_of(q, fibres.branches.size());
    double gain = 0.;
    for (std::size_t i = 0; i < fibres.branches.size(); ++i)
      gain += of_branch++->gain;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int k = 0; k < 2; ++k)
      {
        const double by_f = fibres.weight * (gain * n[i] * n[k] + overstress / l * ((i == k ? 1. : 0.) - n[i] * n[k]));
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int L = 0; L < 2; ++L)
            T[i][J][k][L] += by_f * N[J] * N[L];
      }
    q += fibres.branches.size();
  }
  return T;
}
} // namespace latcon::continuum
