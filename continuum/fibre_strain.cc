#include "continuum/fibre_strain.h"

#include "continuum/errors.h"
#include "support/full_precision.h"

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

using dealii::outer_product;
using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// Row of FibreStrain::Pair to which a derivative of u contributes.
unsigned int row_of(const unsigned int derivative)
{
  return derivative < n_first ? 0 : 1;
}
} // namespace

StrainMeasure stretch_measure(const Tensor<1, 2> &N, const double weight)
{
  return {false, weight, {N[0], N[1]}};
}

double squared_length_along(const double length, const double gradient_length)
{
  constexpr double rounding = 1e-14;
  const double along = gradient_length * gradient_length - length * length / 12.;
  return std::abs(along) <= rounding * gradient_length * gradient_length ? 0. : along;
}

std::array<StrainMeasure, 2> gradient_measures(const Tensor<1, 2> &N, const double weight, const double length,
                                               const double gradient_length)
{
  const double along = squared_length_along(length, gradient_length);
  require(length > 0. && std::isfinite(length),
          "fibres whose law has a gradient part need a positive and finite length");
  require(along >= 0. && std::isfinite(gradient_length),
          "the micro-inertia length must be at least " + support::full_precision(length / std::sqrt(12.)) +
            " m, the length of the bonds over sqrt(12), for the gradient part of a law to be positive");
  const auto measure = [&](const Tensor<1, 2> &M, const double squared_length)
  {
    return StrainMeasure{
      true, weight * squared_length, {N[0], N[1], N[0] * M[0], N[1] * M[1], N[0] * M[1] + N[1] * M[0]}};
  };
  return {measure(Tensor<1, 2>({-N[1], N[0]}), gradient_length * gradient_length), measure(N, along)};
}

FibreStrain::FibreStrain(const StrainMeasure &measure, const FieldDerivatives &u) : measure_(measure)
{
  const Pair changes = rates(u);
  const Tensor<1, 2> f = Tensor<1, 2>({measure.factors[0], measure.factors[1]}) + changes[0];
  const double l = f.norm();
  const Tensor<1, 2> n = f / l;
  const Tensor<2, 2> identity(dealii::unit_symmetric_tensor<2>());
  const Tensor<2, 2> turning = (identity - outer_product(n, n)) / l; // dn_i/df_k
  if (!measure.is_gradient)
  {
    value_ = l;
    first_[0] = n;
    by_ff_ = turning;
    return;
  }
  const Tensor<1, 2> &a = changes[1];
  value_ = n * a;
  first_[0] = turning * a;
  first_[1] = n;
  by_fa_ = turning;
  by_ff_ = (value_ * (3. * outer_product(n, n) - identity) - outer_product(a, n) - outer_product(n, a)) / (l * l);
}

// f and a are linear in u, but for the constant N.
FibreStrain::Pair FibreStrain::rates(const FieldDerivatives &v) const
{
  Pair sum;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = 0; c < n_factors(); ++c)
      sum[row_of(c)][i] += measure_.factors[c] * v[i][c];
  return sum;
}

FibreStrain::Pair FibreStrain::rate_by_state(const FieldDerivatives &v) const
{
  const Pair rate = rates(v);
  Pair by_state;
  by_state[0] = by_ff_ * rate[0] + by_fa_ * rate[1];
  by_state[1] = by_fa_ * rate[0];
  return by_state;
}

void FibreStrain::add_force(const double q, PointIntegrand &density) const
{
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = 0; c < n_factors(); ++c)
      density.first[i][c] += q * measure_.factors[c] * first_[row_of(c)][i];
}

void FibreStrain::add_stiffness(const double q, const Pair &by_state, PointIntegrand &density) const
{
  Tensor<2, 2> second[2][2] = {{q * by_ff_, q * by_fa_}, {q * by_fa_, Tensor<2, 2>()}}; // of f and a
  for (unsigned int r = 0; r < 2; ++r)
    for (unsigned int s = 0; s < 2; ++s)
      second[r][s] += outer_product(first_[r], by_state[s]);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int c = 0; c < n_factors(); ++c)
        for (unsigned int b = 0; b < n_factors(); ++b)
          density.second[i][k][c][b] += measure_.factors[c] * measure_.factors[b] * second[row_of(c)][row_of(b)][i][k];
}
} // namespace latcon::continuum
