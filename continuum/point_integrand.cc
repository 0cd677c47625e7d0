#include "continuum/point_integrand.h"

#include <cstring>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
Tensor<3, 2> second_gradient(const FieldDerivatives &u)
{
  Tensor<3, 2> G;
  for (unsigned int i = 0; i < 2; ++i)
  {
    G[i][0][0] = u[i][2];
    G[i][1][1] = u[i][3];
    G[i][0][1] = G[i][1][0] = u[i][4];
  }
  return G;
}

// Component c of the second derivatives represents the entries (J, K) and (K, J).
constexpr unsigned int first_index[n_derivatives] = {0, 1, 0, 1, 0};
constexpr unsigned int second_index[n_derivatives] = {0, 0, 0, 1, 1};
constexpr double multiplicity[n_derivatives] = {1., 1., 1., 1., 2.};

// Adds factor * tensor of a law to the second derivatives on side s.
void add_G_F(PointIntegrand &d, const unsigned int s, const Tensor<5, 2> &T, const double factor)
{
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      for (unsigned int l = 0; l < 2; ++l)
        for (unsigned int M = 0; M < 2; ++M)
        {
          const double value = factor * multiplicity[c] * T[i][first_index[c]][second_index[c]][l][M];
          d.second[i][l][s][c][s][M] += value;
          d.second[l][i][s][M][s][c] += value;
        }
}

void add_G_G(PointIntegrand &d, const unsigned int s, const Tensor<6, 2> &T, const double factor)
{
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      for (unsigned int l = 0; l < 2; ++l)
        for (unsigned int e = n_first; e < n_derivatives; ++e)
          d.second[i][l][s][c][s][e] += factor * multiplicity[c] * multiplicity[e] *
                                        T[i][first_index[c]][second_index[c]][l][first_index[e]][second_index[e]];
}
// Factor of the interior penalty, with derivatives by the ratio of the stiffness to the supported one: 1 up to ratio 1,
// at least 0.82 ratio beyond, eq. (C.59). Twice continuously differentiable, as Newton's method needs.
struct PenaltyFactor
{
  double value, first, second;
};

PenaltyFactor penalty_factor(const double ratio)
{
  if (!(ratio > 1.))
    return {1., 0., 0.};
  constexpr double d = 0.25;
  const double x = ratio - 1.;
  const double xx = x * x;
  const double n = xx + d;
  return {1. + x * xx / n, xx * (xx + 3. * d) / (n * n), 2. * d * x * (3. * d - xx) / (n * n * n)};
}
} // namespace

void clear(PointIntegrand &density, const Order order)
{
  density.value = 0.;
  std::memset(density.first, 0, sizeof(density.first));
  if (order == Order::second)
    std::memset(density.second, 0, sizeof(density.second));
}

Tensor<2, 2> deformation_gradient(const FieldDerivatives &u)
{
  Tensor<2, 2> F;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      F[i][J] = (i == J ? 1. : 0.) + u[i][J];
  return F;
}

void add_stress(PointIntegrand &d, const Tensor<2, 2> &P)
{
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      d.first[i][0][J] += P[i][J];
}

void add_F_F(PointIntegrand &d, const unsigned int s, const Tensor<4, 2> &T, const double factor)
{
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          d.second[i][k][s][J][s][L] += factor * T[i][J][k][L];
}

void cell_density(const Constitution &laws, const bool has_gradient, const FieldDerivatives &u, const Order order,
                  PointIntegrand &d)
{
  const Tensor<2, 2> F = deformation_gradient(u);
  const Response W = laws.local->evaluate(F, order);
  d.value = W.energy;
  add_stress(d, W.first_piola);
  if (order == Order::second)
    add_F_F(d, 0, W.tangent, 1.);
  if (!has_gradient)
    return;
  const Tensor<3, 2> G = second_gradient(u);
  const GradientForm B = laws.gradient->evaluate(F, G, G, order); // twice the energy
  d.value += 0.5 * B.value;
  if (order == Order::value)
    return;
  add_stress(d, 0.5 * B.by_F);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      d.first[i][0][c] = multiplicity[c] * B.by_Z[i][first_index[c]][second_index[c]];
  if (order == Order::first)
    return;
  add_F_F(d, 0, B.by_FF, 0.5);
  add_G_F(d, 0, B.by_ZF, 1.);
  add_G_G(d, 0, B.by_GZ, 1.);
}

void face_density(const GradientLaw &law, const std::array<FieldDerivatives, 2> &u, const unsigned int n_sides,
                  const Tensor<1, 2> &N, const Tensor<1, 2> &prescribed, const std::array<bool, 2> &held,
                  const FacePenalty &penalty, const Order order, PointIntegrand &d)
{
  const double sign[2] = {1., -1.};
  const double share = 1. / n_sides;
  Tensor<1, 2> z = -prescribed;
  for (unsigned int s = 0; s < n_sides; ++s)
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        z[i] += sign[s] * u[s][i][J] * N[J];
  for (unsigned int i = 0; i < 2; ++i)
    if (!held[i])
      z[i] = 0.;
  const Tensor<2, 2> NN = outer_product(N, N);
  const Tensor<3, 2> Z = outer_product(z, NN);

  double stiffness = 0.;
  for (unsigned int s = 0; s < n_sides; ++s)
    stiffness += share * law.stiffness_across(deformation_gradient(u[s]), N);
  const PenaltyFactor factor = penalty_factor(stiffness / penalty.supported);
  const double sigma = penalty.base * factor.value;
  const double sigma_by_stiffness = penalty.base * factor.first / penalty.supported;
  std::array<Tensor<2, 2>, 2> stiffness_by_F;

  d.value = 0.5 * sigma * z.norm_square();
  Tensor<1, 2> by_z = sigma * z;
  for (unsigned int s = 0; s < n_sides; ++s)
  {
    const Tensor<2, 2> F = deformation_gradient(u[s]);
    const Tensor<3, 2> G = second_gradient(u[s]);
    const GradientForm B = law.evaluate(F, G, Z, order);
    d.value -= share * B.value;
    if (order == Order::value)
      continue;

    for (unsigned int i = 0; i < 2; ++i)
      by_z[i] -= share * scalar_product(B.by_Z[i], NN);
    if (sigma_by_stiffness != 0.)
      for (unsigned int i = 0; i < 2; ++i)
      {
        const Tensor<3, 2> unit = GradientLaw::unit_jump(i, NN);
        const GradientForm of_unit = law.evaluate(F, unit, unit, order);
        stiffness_by_F[s] += share * of_unit.by_F;
        if (order == Order::second)
          add_F_F(d, s, of_unit.by_FF, 0.5 * share * sigma_by_stiffness * z.norm_square());
      }
    const Tensor<2, 2> by_stiffness = 0.5 * sigma_by_stiffness * z.norm_square() * stiffness_by_F[s];
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = 0; c < n_derivatives; ++c)
        d.first[i][s][c] -= c < n_first ? share * B.by_F[i][c] - by_stiffness[i][c]
                                        : share * multiplicity[c] * B.by_G[i][first_index[c]][second_index[c]];
    if (order == Order::first)
      continue;

    add_F_F(d, s, B.by_FF, -share);
    add_G_F(d, s, B.by_GF, -share);
    // Derivative of by_z by the derivatives on this side; z depends on both sides.
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int l = 0; l < 2 && held[i]; ++l)
        for (unsigned int c = 0; c < n_derivatives; ++c)
        {
          double value = c < n_first ? sigma_by_stiffness * z[i] * stiffness_by_F[s][l][c] : 0.;
          for (unsigned int J = 0; J < 2; ++J)
            for (unsigned int K = 0; K < 2; ++K)
              value -= share * NN[J][K] *
                       (c < n_first ? B.by_ZF[i][J][K][l][c]
                                    : multiplicity[c] * B.by_GZ[i][J][K][l][first_index[c]][second_index[c]]);
          for (unsigned int t = 0; t < n_sides; ++t)
            for (unsigned int J = 0; J < 2; ++J)
            {
              d.second[i][l][t][J][s][c] += sign[t] * N[J] * value;
              d.second[l][i][s][c][t][J] += sign[t] * N[J] * value;
            }
        }
  }
  if (order == Order::value)
    return;
  for (unsigned int s = 0; s < n_sides; ++s)
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2 && held[i]; ++J)
        d.first[i][s][J] += sign[s] * by_z[i] * N[J];
  if (order == Order::first)
    return;
  for (unsigned int s = 0; s < n_sides; ++s)
    for (unsigned int t = 0; t < n_sides; ++t)
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2 && held[i]; ++J)
          for (unsigned int L = 0; L < 2; ++L)
            d.second[i][i][s][J][t][L] += sign[s] * sign[t] * sigma * N[J] * N[L];
  if (factor.second == 0.)
    return;
  const double curvature =
    0.5 * penalty.base * factor.second / (penalty.supported * penalty.supported) * z.norm_square();
  for (unsigned int s = 0; s < n_sides; ++s)
    for (unsigned int t = 0; t < n_sides; ++t)
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int l = 0; l < 2; ++l)
            for (unsigned int M = 0; M < 2; ++M)
              d.second[i][l][s][J][t][M] += curvature * stiffness_by_F[s][i][J] * stiffness_by_F[t][l][M];
}
} // namespace latcon::continuum
