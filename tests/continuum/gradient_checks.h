#pragma once

// Properties of every gradient law: derivatives, compared with automatic differentiation of the energy in the form of
// theory-continuum.md, eq. (C.22).

#include "continuum/errors.h"
#include "sheets.h"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace gradient_checks
{
using namespace sheets;
using latcon::continuum::BondFamily;
using latcon::continuum::GradientLaw;
using latcon::continuum::LatticeGradient;
using latcon::continuum::Order;

using Gradient = GradientLaw::Gradient;
using Fad = Sacado::Fad::DFad<double>;
using FadFad = Sacado::Fad::DFad<Fad>;

inline const double epsilon = std::numeric_limits<double>::epsilon();
constexpr double spacing = 0.625e-3;

// F_11 F_12 F_21 F_22, then G_i11 G_i22 G_i12 for i = 1, 2.
constexpr unsigned int n_variables = 10;
constexpr unsigned int place[2][2] = {{0, 2}, {2, 1}};
inline unsigned int variable(const unsigned int i, const unsigned int J)
{
  return 2 * i + J;
}
inline unsigned int variable(const unsigned int i, const unsigned int J, const unsigned int K)
{
  return 4 + 3 * i + place[J][K];
}

// Energy: sum over the bonds of c/2 [ l_d^2 (G_.JK N_K).H.(G_.JL N_L) - (l^2/12) (G:NN).H.(G:NN) ], with the stiffness
// of the bond H = psi'' n n + w (psi'/stretch) (I - n n), where w rises from 0 at stretch 1 to 1 at full_stretch.
template <typename Number>
Number lattice_energy(const std::vector<BondFamily> &bonds, const double length,
                      const std::array<Number, n_variables> &v)
{
  Number W(0.);
  for (const BondFamily &bond : bonds)
  {
    const auto &N = bond.fibre.direction;
    Number n[2], stretch(0.);
    for (unsigned int i = 0; i < 2; ++i)
    {
      n[i] = v[variable(i, 0)] * N[0] + v[variable(i, 1)] * N[1];
      stretch += n[i] * n[i];
    }
    stretch = sqrt(stretch);
    for (Number &component : n)
      component /= stretch;
    Number psi1, psi2;
    if (const auto *rod = std::get_if<latcon::continuum::RodPotential>(&bond.fibre.potential))
    {
      psi1 = rod->a * (stretch - 1. / (stretch * stretch)) + rod->b * (1. - 1. / (stretch * stretch * stretch));
      psi2 = rod->a * (1. + 2. / (stretch * stretch * stretch)) + 3. * rod->b / (stretch * stretch * stretch * stretch);
    }
    else
    {
      const double e = std::get<latcon::continuum::LinearPotential>(bond.fibre.potential).e;
      psi1 = e * (stretch - 1.);
      psi2 = e;
    }
    Number across = psi1 / stretch;
    const Number t = (stretch - 1.) / (LatticeGradient::full_stretch - 1.);
    if (t < 1.)
      across *= t > 0. ? Number(10. * t * t * t - 15. * t * t * t * t + 6. * t * t * t * t * t) : Number(0.);
    const auto h = [&](const Number(&a)[2]) -> Number
    {
      const Number along = a[0] * n[0] + a[1] * n[1];
      return psi2 * along * along + across * (a[0] * a[0] + a[1] * a[1] - along * along);
    };
    Number twice[2] = {0., 0.};
    for (unsigned int J = 0; J < 2; ++J)
    {
      Number once[2];
      for (unsigned int i = 0; i < 2; ++i)
      {
        once[i] = v[variable(i, J, 0)] * N[0] + v[variable(i, J, 1)] * N[1];
        twice[i] += once[i] * N[J];
      }
      W += 0.5 * bond.fibre.weight * length * length * h(once);
    }
    W -= 0.5 * bond.fibre.weight * bond.length * bond.length / 12. * h(twice);
  }
  return W;
}

inline std::vector<BondFamily> mixed_bonds()
{
  return {{{Tensor<1, 2>({1., 0.}), 0.7, latcon::continuum::RodPotential{1e5, 1.5e5}}, 1.3 * spacing},
          {{Tensor<1, 2>({0.6, 0.8}), 1.1, latcon::continuum::LinearPotential{2e5}}, 0.8 * spacing},
          {{Tensor<1, 2>({-0.28, 0.96}), 0.4, latcon::continuum::RodPotential{2e5, -0.5e5}}, spacing}};
}

// Computes value, first and second derivatives of an energy by the ten variables.
template <typename Energy>
FadFad differentiated(const Energy &energy, const Tensor<2, 2> &F, const Gradient &G)
{
  std::array<FadFad, n_variables> v;
  const auto set = [&v](const unsigned int n, const double value)
  { v[n] = FadFad(n_variables, n, Fad(n_variables, n, value)); };
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
    {
      set(variable(i, J), F[i][J]);
      for (unsigned int K = 0; K < 2; ++K)
        set(variable(i, J, K), G[i][J][K]);
    }
  return energy(v);
}

// A sum of several hundred terms, each with several rounding errors; scale is their size.
constexpr double roundings = 300.;

// Checks at principal stretches from `low` to `high`; `condition` is the rate at which the energy varies, relative to
// F.
template <typename Energy>
void expect_derivatives(const GradientLaw &law, const Energy &energy, const double low = 0.8, const double high = 3.,
                        const double condition = 1.)
{
  std::mt19937 generator(3);
  for (int sample = 0; sample < 30; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator, low, high);
    const Gradient G = random_gradient(generator, spacing);
    const FadFad at_G = differentiated(energy, F, G);
    const double tolerance = roundings * epsilon * condition * at_G.val().val();
    const double per_G = spacing; // derivatives by G are larger by the inverse of the size of G

    const auto W = law.evaluate(F, G, Order::second);
    EXPECT_NEAR(W.energy, at_G.val().val(), tolerance);
    EXPECT_EQ(law.energy(F, G), W.energy);
    EXPECT_EQ(law.first_piola_stress(F, G), W.first_piola);
    EXPECT_EQ(law.double_stress(F, G), W.double_stress);
    EXPECT_EQ(law.double_stress_by_G(F), W.double_stress_by_G);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        EXPECT_NEAR(W.first_piola[i][J], at_G.dx(variable(i, J)).val(), 10. * tolerance);
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            EXPECT_NEAR(W.tangent[i][J][k][L], at_G.dx(variable(i, J)).dx(variable(k, L)), 100. * tolerance);
        for (unsigned int K = 0; K < 2; ++K)
        {
          // One variable represents G_i12 and G_i21.
          const double half = J == K ? 1. : 0.5;
          const auto by_Q = at_G.dx(variable(i, J, K));
          EXPECT_NEAR(W.double_stress[i][J][K], half * by_Q.val(), 10. * per_G * tolerance);
          for (unsigned int l = 0; l < 2; ++l)
            for (unsigned int M = 0; M < 2; ++M)
            {
              EXPECT_NEAR(W.double_stress_by_F[i][J][K][l][M], half * by_Q.dx(variable(l, M)),
                          100. * per_G * tolerance);
              for (unsigned int N = 0; N < 2; ++N)
                EXPECT_NEAR(W.double_stress_by_G[i][J][K][l][M][N],
                            half * (M == N ? 1. : 0.5) * by_Q.dx(variable(l, M, N)), 100. * per_G * per_G * tolerance);
            }
        }
      }
  }
}

// Returns G in a reference configuration rotated by R.
inline Gradient turned(const Gradient &G, const Tensor<2, 2> &R)
{
  Gradient result;
  for (unsigned int i = 0; i < 2; ++i)
    result[i] = R * G[i] * transpose(R);
  return result;
}

// Returns n . A . n with A from the second normal derivative, divided by the mass: contribution of the law to the
// coefficient of k^4 in w^2.
inline double symbol(const GradientLaw &law, const Tensor<2, 2> &F, const Tensor<1, 2> &k, const Tensor<1, 2> &p)
{
  const Gradient G = outer_product(p, outer_product(k, k));
  return 2. * law.energy(F, G);
}
} // namespace gradient_checks
