#include "continuum/fibres.h"

#include "continuum/errors.h"

#include <cmath>

namespace latcon::continuum
{
namespace
{
PotentialDerivatives of(const RodPotential &p, const double l)
{
  const double r = 1. / l;
  const double r2 = r * r;
  const double r3 = r2 * r;
  const double r4 = r2 * r2;
  return {p.a * (0.5 * l * l + r - 1.5) + p.b * (l + 0.5 * r2 - 1.5), p.a * (l - r2) + p.b * (1. - r3),
          p.a * (1. + 2. * r3) + 3. * p.b * r4, -6. * p.a * r4 - 12. * p.b * r4 * r,
          24. * p.a * r4 * r + 60. * p.b * r3 * r3};
}

PotentialDerivatives of(const LinearPotential &p, const double l)
{
  return {0.5 * p.e * (l - 1.) * (l - 1.), p.e * (l - 1.), p.e, 0., 0.};
}

PotentialDerivatives of(const CustomPotential &p, const double l)
{
  return p.law->derivatives(l);
}
} // namespace

std::vector<dealii::Tensor<1, 2>> directions(const unsigned int n)
{
  std::vector<dealii::Tensor<1, 2>> all;
  for (unsigned int k = 0; k < n; ++k)
  {
    const double angle = std::acos(-1.) * k / n;
    all.push_back(dealii::Tensor<1, 2>({std::cos(angle), std::sin(angle)}));
  }
  return all;
}

PotentialDerivatives derivatives(const FibrePotential &potential, const double l)
{
  return std::visit([l](const auto &p) { return of(p, l); }, potential);
}

void check_fibre(const dealii::Tensor<1, 2> &direction, const double weight, const std::string &name)
{
  require(std::abs(direction.norm() - 1.) <= 1e-12, "the direction of " + name + " must be a unit vector");
  require(weight > 0. && std::isfinite(weight), "the weight of " + name + " must be positive and finite");
}

void check(const FibreFamily &family)
{
  check_fibre(family.direction, family.weight, "a fibre family");
  const double stiffness = derivatives(family.potential, 1.).second;
  require(stiffness > 0. && std::isfinite(stiffness), "a fibre must have a positive and finite stiffness at stretch 1");
}
} // namespace latcon::continuum
