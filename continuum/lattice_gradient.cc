#include "continuum/lattice_gradient.h"

#include "continuum/errors.h"
#include "continuum/material.h"

#include <algorithm>
#include <cmath>

using dealii::outer_product;
using dealii::Tensor;

namespace continuum
{
namespace
{
// Derivatives of chi(s) = psi(l), s = l^2/2, by s: d/ds = (1/l) d/dl. In them the derivatives of psi(|f|) by the vector
// f have no quotients, eq. (C.24).
struct Chi
{
  double first, second, third, fourth;
};

Chi chi(const FibrePotential &potential, const double l)
{
  const PotentialDerivatives psi = derivatives(potential, l);
  const double r = 1. / l;
  return {psi.first * r, (psi.second - psi.first * r) * r * r,
          (psi.third - 3. * r * (psi.second - r * psi.first)) * r * r * r,
          (psi.fourth - 6. * r * psi.third + 15. * r * r * (psi.second - r * psi.first)) * r * r * r * r};
}

Tensor<1, 2> selected(const GradientLaw::Gradient &G, const Tensor<2, 2> &selector)
{
  Tensor<1, 2> a;
  for (unsigned int i = 0; i < 2; ++i)
    a[i] = scalar_product(G[i], selector);
  return a;
}
} // namespace

double LatticeGradient::smallest_length(const std::vector<BondFamily> &families)
{
  double longest = 0.;
  for (const BondFamily &family : families)
    longest = std::max(longest, family.length);
  return longest / std::sqrt(12.);
}

LatticeGradient::LatticeGradient(const std::vector<BondFamily> &families, const double length)
{
  if (families.empty())
    throw InvalidMaterial("a lattice gradient energy needs at least one family of bonds");
  if (!std::isfinite(length))
    throw InvalidMaterial("the micro-inertia length of a lattice gradient energy must be finite");
  for (const BondFamily &family : families)
  {
    check(family.fibre);
    if (!(family.length > 0. && std::isfinite(family.length)))
      throw InvalidMaterial("a bond needs a positive and finite length");
    // At the smallest length the difference vanishes but for rounding, and must not come out negative.
    constexpr double rounding = 1e-14;
    double along = length * length - family.length * family.length / 12.;
    if (std::abs(along) <= rounding * length * length)
      along = 0.;
    if (along < 0.)
      throw InvalidMaterial("the micro-inertia length must be at least " + std::to_string(smallest_length(families)) +
                            " m, the longest bond over sqrt(12), or the gradient energy is not positive");
    const Tensor<1, 2> &N = family.fibre.direction;
    const Tensor<1, 2> T({-N[1], N[0]});
    families_.push_back({family.fibre,
                         {0.5 * (outer_product(N, T) + outer_product(T, N)), outer_product(N, N)},
                         {family.fibre.weight * length * length, family.fibre.weight * along}});
  }
}

double LatticeGradient::form(const Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const
{
  checked_determinant(F);
  double B = 0.;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> f = F * family.fibre.direction;
    const Chi c = chi(family.fibre.potential, f.norm());
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<1, 2> a = selected(G, family.selector[term]);
      const Tensor<1, 2> b = selected(Z, family.selector[term]);
      B += family.factor[term] * (c.first * (a * b) + c.second * (f * a) * (f * b));
    }
  }
  return B;
}

Tensor<2, 2> LatticeGradient::form_by_F(const Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const
{
  checked_determinant(F);
  Tensor<2, 2> result;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> f = F * family.fibre.direction;
    const Chi c = chi(family.fibre.potential, f.norm());
    Tensor<1, 2> by_f;
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<1, 2> a = selected(G, family.selector[term]);
      const Tensor<1, 2> b = selected(Z, family.selector[term]);
      by_f += family.factor[term] *
              ((c.second * (a * b) + c.third * (f * a) * (f * b)) * f + c.second * ((f * b) * a + (f * a) * b));
    }
    result += outer_product(by_f, family.fibre.direction);
  }
  return result;
}

Tensor<4, 2> LatticeGradient::form_by_FF(const Tensor<2, 2> &F, const Gradient &G, const Gradient &Z) const
{
  checked_determinant(F);
  Tensor<4, 2> result;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> &N = family.fibre.direction;
    const Tensor<1, 2> f = F * N;
    const Chi c = chi(family.fibre.potential, f.norm());
    Tensor<2, 2> by_ff;
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<1, 2> a = selected(G, family.selector[term]);
      const Tensor<1, 2> b = selected(Z, family.selector[term]);
      const double ab = a * b;
      const double fa_fb = (f * a) * (f * b);
      const Tensor<1, 2> mixed = (f * b) * a + (f * a) * b;
      Tensor<2, 2> h = (c.third * ab + c.fourth * fa_fb) * outer_product(f, f) +
                       c.third * (outer_product(f, mixed) + outer_product(mixed, f)) +
                       c.second * (outer_product(a, b) + outer_product(b, a));
      for (unsigned int i = 0; i < 2; ++i)
        h[i][i] += c.second * ab + c.third * fa_fb;
      by_ff += family.factor[term] * h;
    }
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            result[i][J][k][L] += by_ff[i][k] * N[J] * N[L];
  }
  return result;
}

GradientLaw::Gradient LatticeGradient::double_stress(const Tensor<2, 2> &F, const Gradient &G) const
{
  checked_determinant(F);
  Gradient Q;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> f = F * family.fibre.direction;
    const Chi c = chi(family.fibre.potential, f.norm());
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<1, 2> a = selected(G, family.selector[term]);
      Q += family.factor[term] * outer_product(c.first * a + c.second * (f * a) * f, family.selector[term]);
    }
  }
  return Q;
}

Tensor<5, 2> LatticeGradient::double_stress_by_F(const Tensor<2, 2> &F, const Gradient &G) const
{
  checked_determinant(F);
  Tensor<5, 2> result;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> &N = family.fibre.direction;
    const Tensor<1, 2> f = F * N;
    const Chi c = chi(family.fibre.potential, f.norm());
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<1, 2> a = selected(G, family.selector[term]);
      const double fa = f * a;
      Tensor<2, 2> h = c.second * (outer_product(a, f) + outer_product(f, a)) + c.third * fa * outer_product(f, f);
      for (unsigned int i = 0; i < 2; ++i)
        h[i][i] += c.second * fa;
      h *= family.factor[term];
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
            for (unsigned int l = 0; l < 2; ++l)
              for (unsigned int M = 0; M < 2; ++M)
                result[i][J][K][l][M] += h[i][l] * family.selector[term][J][K] * N[M];
    }
  }
  return result;
}

Tensor<6, 2> LatticeGradient::double_stress_by_G(const Tensor<2, 2> &F) const
{
  checked_determinant(F);
  Tensor<6, 2> result;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> f = F * family.fibre.direction;
    const Chi c = chi(family.fibre.potential, f.norm());
    Tensor<2, 2> H = c.second * outer_product(f, f);
    for (unsigned int i = 0; i < 2; ++i)
      H[i][i] += c.first;
    for (unsigned int term = 0; term < 2; ++term)
    {
      const Tensor<2, 2> &S = family.selector[term];
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
            for (unsigned int l = 0; l < 2; ++l)
              for (unsigned int M = 0; M < 2; ++M)
                for (unsigned int N = 0; N < 2; ++N)
                  result[i][J][K][l][M][N] += family.factor[term] * H[i][l] * S[J][K] * S[M][N];
    }
  }
  return result;
}
} // namespace continuum
