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

void add(const Response &W, const Order order, PointIntegrand &d)
{
  d.value += W.energy;
  if (order == Order::value)
    return;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      d.first[i][J] += W.first_piola[i][J];
  if (order == Order::first)
    return;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          d.second[i][k][J][L] += W.tangent[i][J][k][L];
}

// Component c of the second derivatives represents the entries (J, K) and (K, J).
constexpr unsigned int first_index[n_derivatives] = {0, 1, 0, 1, 0};
constexpr unsigned int second_index[n_derivatives] = {0, 0, 0, 1, 1};
constexpr double multiplicity[n_derivatives] = {1., 1., 1., 1., 2.};
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

FieldDerivatives field_derivatives(const Tensor<2, 2> &F, const Tensor<3, 2> &G)
{
  FieldDerivatives u;
  for (unsigned int i = 0; i < 2; ++i)
  {
    u[i] = {F[i][0], F[i][1], G[i][0][0], G[i][1][1], G[i][0][1]};
    u[i][i] -= 1.;
  }
  return u;
}

void add_energy(const Material &law, const FieldDerivatives &u, const Order order, PointIntegrand &d)
{
  add(law.evaluate(deformation_gradient(u), order), order, d);
}

void add_energy(const GradientLaw &law, const FieldDerivatives &u, const Order order, PointIntegrand &d)
{
  const GradientResponse W = law.evaluate(deformation_gradient(u), second_gradient(u), order);
  add(W, order, d);
  if (order == Order::value)
    return;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      d.first[i][c] += multiplicity[c] * W.double_stress[i][first_index[c]][second_index[c]];
  if (order == Order::first)
    return;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      for (unsigned int l = 0; l < 2; ++l)
      {
        for (unsigned int M = 0; M < 2; ++M)
        {
          const double value = multiplicity[c] * W.double_stress_by_F[i][first_index[c]][second_index[c]][l][M];
          d.second[i][l][c][M] += value;
          d.second[l][i][M][c] += value;
        }
        for (unsigned int e = n_first; e < n_derivatives; ++e)
          d.second[i][l][c][e] +=
            multiplicity[c] * multiplicity[e] *
            W.double_stress_by_G[i][first_index[c]][second_index[c]][l][first_index[e]][second_index[e]];
      }
}
} // namespace latcon::continuum
