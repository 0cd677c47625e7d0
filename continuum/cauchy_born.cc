#include "continuum/cauchy_born.h"

#include "continuum/errors.h"

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
CauchyBorn::CauchyBorn(std::vector<FibreFamily> families) : families_(std::move(families))
{
  if (families_.empty())
    throw InvalidMaterial("a fibre network needs at least one family");
  for (const FibreFamily &family : families_)
    check(family);
}

double CauchyBorn::energy(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  double W = 0.;
  for (const FibreFamily &family : families_)
  {
    const double l = (F * family.direction).norm();
    W += family.weight * derivatives(family.potential, l).value;
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
    const double force = derivatives(family.potential, l).first;
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
    const PotentialDerivatives psi = derivatives(family.potential, l);
    const double across = family.weight * psi.first / l;
    const double along = (family.weight * psi.second - across) / (l * l);
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
} // namespace latcon::continuum
