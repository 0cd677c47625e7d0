#include "continuum/viscosity.h"

#include "continuum/errors.h"
#include "continuum/gradient_viscosity.h"
#include "continuum/material.h"

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// Kinematics of a family in the state (F, Fdot).
struct Stretching
{
  double stretch;    // l [-]
  double rate;       // dl/dt [1/s]
  Tensor<1, 2> n;    // current direction
  Tensor<1, 2> spin; // (Fdot N)_k (delta_ki - n_k n_i)/l = dn_i/dt [1/s]
};

Stretching stretching(const FibreDashpot &dashpot, const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot)
{
  const Tensor<1, 2> f = F * dashpot.direction;
  const Tensor<1, 2> g = Fdot * dashpot.direction;
  const double l = f.norm();
  const Tensor<1, 2> n = f / l;
  const double rate = n * g;
  return {l, rate, n, (g - rate * n) / l};
}
} // namespace

double Viscosity::dissipation(const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot) const
{
  return scalar_product(stress(F, Fdot), Fdot);
}

void check(const FibreDashpot &dashpot)
{
  if (!(std::abs(dashpot.direction.norm() - 1.) <= 1e-12))
    throw InvalidMaterial("the direction of a dashpot must be a unit vector");
  if (!(dashpot.weight > 0. && std::isfinite(dashpot.weight)))
    throw InvalidMaterial("the weight of a dashpot must be positive and finite");
  if (!(dashpot.viscosity >= 0. && std::isfinite(dashpot.viscosity)))
    throw InvalidMaterial("the viscosity of a dashpot must be finite and not negative");
}

FibreViscosity::FibreViscosity(std::vector<FibreDashpot> dashpots, const double gradient_length)
  : dashpots_(std::move(dashpots))
{
  if (dashpots_.empty())
    throw InvalidMaterial("fibre viscosity needs at least one dashpot");
  for (const FibreDashpot &dashpot : dashpots_)
    check(dashpot);
  if (gradient_length != 0.)
    gradient_ = std::make_shared<GradientViscosity>(dashpots_, gradient_length);
}

Tensor<2, 2> FibreViscosity::stress(const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot) const
{
  checked_determinant(F);
  Tensor<2, 2> P;
  for (const FibreDashpot &dashpot : dashpots_)
  {
    const Stretching s = stretching(dashpot, F, Fdot);
    P += dashpot.weight * dashpot.viscosity * s.rate * outer_product(s.n, dashpot.direction);
  }
  return P;
}

Tensor<4, 2> FibreViscosity::stress_by_F(const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot) const
{
  checked_determinant(F);
  Tensor<4, 2> T;
  for (const FibreDashpot &dashpot : dashpots_)
  {
    const Tensor<1, 2> &N = dashpot.direction;
    const Stretching s = stretching(dashpot, F, Fdot);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int k = 0; k < 2; ++k)
      {
        const double turning = ((i == k ? 1. : 0.) - s.n[i] * s.n[k]) / s.stretch; // dn_i/df_k, f = F N
        const double by_f = dashpot.weight * dashpot.viscosity * (s.n[i] * s.spin[k] + s.rate * turning);
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int L = 0; L < 2; ++L)
            T[i][J][k][L] += by_f * N[J] * N[L];
      }
  }
  return T;
}

Tensor<4, 2> FibreViscosity::stress_by_rate(const Tensor<2, 2> &F, const Tensor<2, 2> &Fdot) const
{
  checked_determinant(F);
  Tensor<4, 2> T;
  for (const FibreDashpot &dashpot : dashpots_)
  {
    const Tensor<2, 2> nN = outer_product(stretching(dashpot, F, Fdot).n, dashpot.direction);
    T += dashpot.weight * dashpot.viscosity * outer_product(nN, nN);
  }
  return T;
}
} // namespace latcon::continuum
