#pragma once

// Energies of laws as they are defined, for numbers that carry derivatives, without code under test.

#include "sheets.h"

#include <Sacado.hpp>

#include <array>
#include <limits>

namespace energies
{
using namespace sheets;

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
using Fad = Sacado::Fad::DFad<double>;
using FadFad = Sacado::Fad::DFad<Fad>;

/// F_11 F_12 F_21 F_22, then G_i11 G_i22 G_i12 for i = 1, 2.
constexpr unsigned int n_variables = 10;
template <class Number>
using Variables = std::array<Number, n_variables>;

inline unsigned int variable(const unsigned int i, const unsigned int J)
{
  return 2 * i + J;
}
inline unsigned int variable(const unsigned int i, const unsigned int J, const unsigned int K)
{
  return 4 + 3 * i + (J == K ? J : 2);
}

inline double without_derivatives(const double number)
{
  return number;
}
template <class Number>
double without_derivatives(const Number &number)
{
  return without_derivatives(number.val());
}

/// Stretch l of a fibre, and its potential with two derivatives.
template <class Number>
struct Fibre
{
  Fibre(const latcon::continuum::FibreFamily &family, const Variables<Number> &v) : potential(family.potential)
  {
    const auto &N = family.direction;
    for (unsigned int i = 0; i < 2; ++i)
      f[i] = v[variable(i, 0)] * N[0] + v[variable(i, 1)] * N[1];
    l2 = f[0] * f[0] + f[1] * f[1];
    l = sqrt(l2);
  }

  Number energy() const
  {
    if (const auto *rod = std::get_if<latcon::continuum::RodPotential>(&potential))
      return rod->a * (0.5 * l2 + 1. / l - 1.5) + rod->b * (l + 0.5 / l2 - 1.5);
    return 0.5 * std::get<latcon::continuum::LinearPotential>(potential).e * (l2 - 2. * l + 1.);
  }
  Number force_by_stretch() const
  {
    if (const auto *rod = std::get_if<latcon::continuum::RodPotential>(&potential))
      return rod->a * (1. - 1. / (l2 * l)) + rod->b * (1. / l - 1. / (l2 * l2));
    return std::get<latcon::continuum::LinearPotential>(potential).e * (1. - 1. / l);
  }
  Number stiffness() const
  {
    if (const auto *rod = std::get_if<latcon::continuum::RodPotential>(&potential))
      return rod->a * (1. + 2. / (l2 * l)) + 3. * rod->b / (l2 * l2);
    return Number(std::get<latcon::continuum::LinearPotential>(potential).e);
  }

  const latcon::continuum::FibrePotential &potential;
  Number f[2], l2, l;
};

struct NetworkEnergy
{
  std::vector<latcon::continuum::FibreFamily> families;

  template <class Number>
  Number operator()(const Variables<Number> &v) const
  {
    Number W(0.);
    for (const auto &family : families)
      W += family.weight * Fibre<Number>(family, v).energy();
    return W;
  }
};

/// Compressible Mooney-Rivlin in plane stress, thickness eliminated by Newton on dw/dt = 0.
struct MooneyRivlinEnergy
{
  latcon::continuum::MooneyRivlin::Constants m;

  template <class Number>
  Number by_thickness(const Number &f, const Number &j, const Number &t) const
  {
    return m.c1 * (2. * t - 2. / t) + m.c2 * (2. * t * f - 4. / t) + m.kappa * (j * t - 1.) * j;
  }
  template <class Number>
  Number by_thickness_twice(const Number &f, const Number &j, const Number &t) const
  {
    return m.c1 * (2. + 2. / (t * t)) + m.c2 * (2. * f + 4. / (t * t)) + m.kappa * j * j;
  }

  template <class Number>
  Number operator()(const Variables<Number> &v) const
  {
    const Number f = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
    const Number j = v[0] * v[3] - v[1] * v[2];
    const double f0 = without_derivatives(f);
    const double j0 = without_derivatives(j);
    double t0 = 1. / j0;
    for (int k = 0; k < 60; ++k)
      t0 -= by_thickness(f0, j0, t0) / by_thickness_twice(f0, j0, t0);
    // Each further Newton step makes one more derivative correct; three derivatives of the thickness are needed.
    Number t(t0);
    for (int k = 0; k < 3; ++k)
    {
      const Number slope = by_thickness_twice(f, j, t);
      const Number residual = by_thickness(f, j, t);
      t -= residual / slope;
    }
    const Number J = j * t;
    const Number log_J = log(J);
    return m.c1 * (f + t * t - 3. - 2. * log_J) + m.c2 * (j * j + t * t * f - 3. - 4. * log_J) +
           0.5 * m.kappa * (J - 1.) * (J - 1.);
  }
};

/// (c/2) |G|^2
struct IsotropicGradientEnergy
{
  double modulus;

  template <class Number>
  Number operator()(const Variables<Number> &v) const
  {
    Number W(0.);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          W += 0.5 * modulus * v[variable(i, J, K)] * v[variable(i, J, K)];
    return W;
  }
};

/// Sum over the bonds of c/2 [ l_d^2 (G_.JK N_K).H.(G_.JL N_L) - (l^2/12) (G:NN).H.(G:NN) ], with the stiffness of the
/// bond H = psi'' n n + w (psi'/stretch) (I - n n), where w rises from 0 at stretch 1 to 1 at full_stretch
/// (theory-continuum.md, eqs. (C.22) and (C.27)).
struct LatticeGradientEnergy
{
  std::vector<latcon::continuum::BondFamily> bonds;
  double length;

  template <class Number>
  Number operator()(const Variables<Number> &v) const
  {
    Number W(0.);
    for (const auto &bond : bonds)
    {
      const auto &N = bond.fibre.direction;
      const Fibre<Number> fibre(bond.fibre, v);
      const Number along = fibre.stiffness();
      Number across = fibre.force_by_stretch();
      if (fibre.l < latcon::continuum::LatticeGradient::full_stretch)
      {
        const Number t = (fibre.l - 1.) / (latcon::continuum::LatticeGradient::full_stretch - 1.);
        across *= t > 0. ? Number(10. * t * t * t - 15. * t * t * t * t + 6. * t * t * t * t * t) : Number(0.);
      }
      const auto h = [&](const Number(&a)[2]) -> Number
      {
        const Number a_n = (a[0] * fibre.f[0] + a[1] * fibre.f[1]) / fibre.l;
        return along * a_n * a_n + across * (a[0] * a[0] + a[1] * a[1] - a_n * a_n);
      };
      Number twice[2] = {Number(0.), Number(0.)};
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
};
} // namespace energies
