#include "continuum/cauchy_born.h"

#include "continuum/errors.h"

using dealii::Tensor;

namespace latcon::continuum
{
CauchyBorn::CauchyBorn(std::vector<FibreFamily> families) : families_(std::move(families))
{
  require(!families_.empty(), "a fibre network needs at least one family");
  for (const FibreFamily &family : families_)
    check(family);
}

Response CauchyBorn::evaluate(const Tensor<2, 2> &F, const Order order) const
{
  checked_determinant(F);
  Response W;
  for (const FibreFamily &family : families_)
  {
    const Tensor<1, 2> &N = family.direction;
    const Tensor<1, 2> fibre = F * N;
    const double l = fibre.norm();
    const PotentialDerivatives psi = derivatives(family.potential, l);
    W.energy += family.weight * psi.value;
    if (order == Order::value)
      continue;
    W.first_piola += family.weight * psi.first / l * dealii::outer_product(fibre, N);
    if (order == Order::first)
      continue;
    const double across = family.weight * psi.first / l;
    const double along = (family.weight * psi.second - across) / (l * l);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            W.tangent[i][J][k][L] += (along * fibre[i] * fibre[k] + (i == k ? across : 0.)) * N[J] * N[L];
  }
  return W;
}
} // namespace latcon::continuum
