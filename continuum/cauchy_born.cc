#include "continuum/cauchy_born.h"

#include "continuum/errors.h"

#include <cmath>

using dealii::Tensor;

namespace continuum
{
namespace
{
// psi and its first two derivatives by the stretch l, eqs. (C.12) and (C.13), one overload for each potential.
double value(const RodPotential &p, const double l)
{
  return p.a * (0.5 * l * l + 1. / l - 1.5) + p.b * (l + 0.5 / (l * l) - 1.5);
}
double slope(const RodPotential &p, const double l)
{
  return p.a * (l - 1. / (l * l)) + p.b * (1. - 1. / (l * l * l));
}
double curvature(const RodPotential &p, const double l)
{
  return p.a * (1. + 2. / (l * l * l)) + 3. * p.b / (l * l * l * l);
}

double value(const LinearPotential &p, const double l)
{
  return 0.5 * p.e * (l - 1.) * (l - 1.);
}
double slope(const LinearPotential &p, const double l)
{
  return p.e * (l - 1.);
}
double curvature(const LinearPotential &p, const double)
{
  return p.e;
}
} // namespace

CauchyBorn::CauchyBorn(std::vector<FibreFamily> families) : families_(std::move(families))
{
  if (families_.empty())
    throw InvalidMaterial("a fibre network needs at least one family");
  for (const FibreFamily &family : families_)
  {
    if (!(std::abs(family.direction.norm() - 1.) <= 1e-12))
      throw InvalidMaterial("the direction of a fibre family must be a unit vector");
    if (!(family.weight > 0. && std::isfinite(family.weight)))
      throw InvalidMaterial("the weight of a fibre family must be positive and finite");
    const double stiffness =
      std::visit([](const auto &potential) { return curvature(potential, 1.); }, family.potential);
    if (!(stiffness > 0. && std::isfinite(stiffness)))
      throw InvalidMaterial("a fibre must have a positive and finite stiffness at stretch 1");
  }
}

double CauchyBorn::energy(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  double W = 0.;
  for (const FibreFamily &family : families_)
  {
    const double l = (F * family.direction).norm();
    W += family.weight * std::visit([l](const auto &potential) { return value(potential, l); }, family.potential);
  }
  return W;
}

Tensor<2, 2> CauchyBorn::first_piola_stress(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  Tensor<2, 2> P;
  for (const FibreFamily &family : families_)
  {
    const Tensor<1, 2> fibre = F * family.direction;
    const double l = fibre.norm();
    const double force = std::visit([l](const auto &potential) { return slope(potential, l); }, family.potential);
    P += family.weight * force / l * dealii::outer_product(fibre, family.direction);
  }
  return P;
}

Tensor<4, 2> CauchyBorn::tangent(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  Tensor<4, 2> T;
  for (const FibreFamily &family : families_)
  {
    const Tensor<1, 2> &N = family.direction;
    const Tensor<1, 2> fibre = F * N;
    const double l = fibre.norm();
    const double force = std::visit([l](const auto &potential) { return slope(potential, l); }, family.potential);
    const double stiffness =
      std::visit([l](const auto &potential) { return curvature(potential, l); }, family.potential);
    const double across = family.weight * force / l;
    const double along = (family.weight * stiffness - across) / (l * l);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            T[i][J][k][L] += (along * fibre[i] * fibre[k] + (i == k ? across : 0.)) * N[J] * N[L];
  }
  return T;
}

double CauchyBorn::thickness_stretch(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  return 1.;
}
} // namespace continuum
