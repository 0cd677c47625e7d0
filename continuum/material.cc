#include "continuum/material.h"

#include "continuum/errors.h"
#include "support/fits.h"
#include "support/text_wrap.h"

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
std::string text_of(const Tensor<2, 2> &F)
{
  return support::formatted("F = [%.17g %.17g; %.17g %.17g]", F[0][0], F[0][1], F[1][0], F[1][1]);
}

double checked_determinant(const Tensor<2, 2> &F)
{
  const double J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  // In this form a NaN fails as well.
  if (!(J > 0. && std::isfinite(J)))
    throw NonPhysicalState(support::formatted("det F = %.17g is not positive and finite: ", J) + text_of(F));
  return J;
}

Tensor<2, 2> cauchy_stress(const Tensor<2, 2> &P, const Tensor<2, 2> &F)
{
  return P * dealii::transpose(F) / checked_determinant(F);
}

double minimum_acoustic_eigenvalue(const Material &law, const Tensor<2, 2> &F)
{
  const Tensor<4, 2> T = law.tangent(F);
  const auto smallest_eigenvalue = [&T](const double angle)
  {
    const double n[2] = {std::cos(angle), std::sin(angle)};
    double Q[2][2] = {{0., 0.}, {0., 0.}};
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            Q[i][k] += T[i][J][k][L] * n[J] * n[L];
    return 0.5 * (Q[0][0] + Q[1][1]) - std::hypot(0.5 * (Q[0][0] - Q[1][1]), Q[0][1]);
  };

  // Q is quadratic in n, so its eigenvalues have few extrema over the half circle: a scan brackets the minimum,
  // golden-section search refines it. Where the eigenvalues cross, the smaller one has a kink that is a maximum, never
  // a minimum.
  const double pi = std::acos(-1.);
  const unsigned int n_samples = 360;
  double best = smallest_eigenvalue(0.);
  double at = 0.;
  for (unsigned int sample = 1; sample < n_samples; ++sample)
  {
    const double angle = pi * sample / n_samples;
    if (const double value = smallest_eigenvalue(angle); value < best)
    {
      best = value;
      at = angle;
    }
  }
  const double angle = support::golden_section(smallest_eigenvalue, at - pi / n_samples, at + pi / n_samples, 1e-8);
  return std::min(best, smallest_eigenvalue(angle));
}
} // namespace latcon::continuum
