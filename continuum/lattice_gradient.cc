#include "continuum/lattice_gradient.h"

#include "continuum/errors.h"
#include "continuum/fibre_strain.h"
#include "continuum/material.h"
#include "support/full_precision.h"

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

using dealii::outer_product;
using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
const Tensor<2, 2> identity(dealii::unit_symmetric_tensor<2>());

// Stiffness of a bond with f = F N against a gradient, h(a, b) = across a.b + coupling (f.a)(f.b). Both coefficients
// have their first two derivatives by s = |f|^2/2, by which the derivatives of h by the vector f contain no quotients,
// eq. (C.24).
struct BondStiffness
{
  double across[3];
  double coupling[3];
};

BondStiffness stiffness(const FibrePotential &potential, const double l)
{
  const PotentialDerivatives psi = derivatives(potential, l);
  const double r = 1. / l;
  const double chi_1 = psi.first * r;
  const double chi_2 = (psi.second - psi.first * r) * r * r;
  const double chi_3 = (psi.third - 3. * r * (psi.second - r * psi.first)) * r * r * r;
  const double chi_4 = (psi.fourth - 6. * r * psi.third + 15. * r * r * (psi.second - r * psi.first)) * r * r * r * r;
  if (l >= LatticeGradient::full_stretch)
    return {{chi_1, chi_2, chi_3}, {chi_2, chi_3, chi_4}};

  // Remove the fraction 1 - w of the transverse stiffness, eq. (C.27), and keep the axial stiffness, across + 2 s
  // coupling = psi''.
  constexpr double width = LatticeGradient::full_stretch - 1.;
  const double t = std::max(0., (l - 1.) / width);
  const double left[3] = {1. - t * t * t * (10. - t * (15. - 6. * t)), -30. * t * t * (1. - t) * (1. - t) / width,
                          -60. * t * (1. - t) * (1. - 2. * t) / (width * width)}; // 1 - w and its derivatives by l
  const double v = left[0];
  const double v_1 = left[1] * r;
  const double v_2 = (left[2] - left[1] * r) * r * r;
  const double away = chi_1 * v;
  const double away_1 = chi_2 * v + chi_1 * v_1;
  const double away_2 = chi_3 * v + 2. * chi_2 * v_1 + chi_1 * v_2;
  const double r2 = r * r;
  return {{chi_1 - away, chi_2 - away_1, chi_3 - away_2},
          {chi_2 + r2 * away, chi_3 + r2 * (away_1 - 2. * r2 * away),
           chi_4 + r2 * (away_2 - 4. * r2 * (away_1 - 2. * r2 * away))}};
}
} // namespace

void check(const BondFamily &family)
{
  check(family.fibre);
  if (!(family.length > 0. && std::isfinite(family.length)))
    throw InvalidInput("a bond needs a positive and finite length");
}

double LatticeGradient::smallest_length(const std::vector<BondFamily> &families)
{
  double longest = 0.;
  for (const BondFamily &family : families)
    longest = std::max(longest, family.length);
  return longest / std::sqrt(12.);
}

LatticeGradient::LatticeGradient(const std::vector<BondFamily> &families, const double length)
{
  require(!families.empty(), "a lattice gradient energy needs at least one family of bonds");
  require(std::isfinite(length), "the micro-inertia length of a lattice gradient energy must be finite");
  for (const BondFamily &family : families)
  {
    check(family);
    const double along = squared_length_along(family.length, length);
    if (along < 0.)
      throw InvalidInput("the micro-inertia length must be at least " +
                         support::full_precision(smallest_length(families)) +
                         " m, the longest bond over sqrt(12), for the gradient energy to be positive");
    const Tensor<1, 2> &N = family.fibre.direction;
    const Tensor<1, 2> T({-N[1], N[0]});
    families_.push_back({family.fibre,
                         {0.5 * (outer_product(N, T) + outer_product(T, N)), outer_product(N, N)},
                         {family.fibre.weight * length * length, family.fibre.weight * along}});
  }
}

GradientResponse LatticeGradient::evaluate(const Tensor<2, 2> &F, const Gradient &G, const Order order) const
{
  checked_determinant(F);
  GradientResponse W;
  for (const Family &family : families_)
  {
    const Tensor<1, 2> &N = family.fibre.direction;
    const Tensor<1, 2> f = F * N;
    const BondStiffness h = stiffness(family.fibre.potential, f.norm());
    // Half the second derivative of h(a, a) by a.
    const Tensor<2, 2> by_aa = h.across[0] * identity + h.coupling[0] * outer_product(f, f);
    Tensor<1, 2> by_f;
    Tensor<2, 2> by_ff;
    for (unsigned int term = 0; term < 2; ++term)
    {
      const double factor = family.factor[term];
      const Tensor<2, 2> &selector = family.selector[term];
      const Tensor<1, 2> a({scalar_product(G[0], selector), scalar_product(G[1], selector)});
      const double aa = a * a, fa = f * a;
      W.energy += 0.5 * factor * (h.across[0] * aa + h.coupling[0] * fa * fa);
      if (order == Order::value)
        continue;
      const double by_s = 0.5 * (h.across[1] * aa + h.coupling[1] * fa * fa); // derivative of h/2 by s = |f|^2/2
      by_f += factor * (by_s * f + h.coupling[0] * fa * a);
      W.double_stress += factor * outer_product(h.across[0] * a + h.coupling[0] * fa * f, selector);
      if (order == Order::first)
        continue;
      by_ff += factor * (0.5 * (h.across[2] * aa + h.coupling[2] * fa * fa) * outer_product(f, f) +
                         h.coupling[1] * fa * (outer_product(f, a) + outer_product(a, f)) +
                         h.coupling[0] * outer_product(a, a) + by_s * identity);
      const Tensor<2, 2> of_F =
        factor * (h.across[1] * outer_product(a, f) + h.coupling[0] * (outer_product(f, a) + fa * identity) +
                  h.coupling[1] * fa * outer_product(f, f));
      const Tensor<2, 2> of_G = factor * by_aa;
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
            for (unsigned int l = 0; l < 2; ++l)
            {
              W.double_stress_by_F[i][J][K][l] += of_F[i][l] * selector[J][K] * N;
              W.double_stress_by_G[i][J][K][l] += of_G[i][l] * selector[J][K] * selector;
            }
    }
    W.first_piola += outer_product(by_f, N);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            W.tangent[i][J][k][L] += by_ff[i][k] * N[J] * N[L];
  }
  return W;
}
} // namespace latcon::continuum
