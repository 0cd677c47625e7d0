#include "continuum/plane_invariants.h"

#include <array>
#include <cmath>
#include <limits>

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// Returns the Legendre function P_{-1/2}(x) and the two quotients of (C.51), from which all means follow without
// cancellation. Computes the arithmetic-geometric mean of sqrt((x + 1)/2) and 1. The squares c_n^2 of its halved
// differences are divided by (x - 1)^2, which avoids cancellation where the principal stretches are equal.
std::array<double, 3> legendre_quotients(const double x)
{
  const double y = x - 1.;
  double a = 0.5 * (std::sqrt(0.5 * (x + 1.)) + 1.);
  double b = std::pow(0.5 * (x + 1.), 0.25);
  double square = 1. / (64. * a * a); // (c_2 / y)^2
  double weight = 2.;
  double d = weight * square;
  // Each step squares the relative difference of a and b; for every finite x, fewer than 16 steps suffice.
  for (int step = 0; step < 16 && a - b > std::numeric_limits<double>::epsilon() * a; ++step)
  {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    square = square * y * (square * y) / (16. * a * a);
    weight *= 2.;
    d += weight * square;
  }
  return {1. / a, 0.5 - y * d, d};
}
} // namespace

Response response(const InvariantFunction &W, const Tensor<2, 2> &F, const Order order)
{
  const auto [value, by_I, by_J, by_II, by_IJ, by_JJ] = std::array{W[0], W[1], W[2], W[3], W[4], W[5]};
  Response result;
  result.energy = value;
  if (order == Order::value)
    return result;
  const Tensor<2, 2> cof({{F[1][1], -F[1][0]}, {-F[0][1], F[0][0]}}); // d det F / dF
  result.first_piola = 2. * by_I * F + by_J * cof;
  if (order == Order::first)
    return result;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
        {
          // The cofactor is linear in F: d cof_iJ / dF_kL = eps_ik eps_JL.
          const double permutation = i == k || J == L ? 0. : (i == J ? 1. : -1.);
          result.tangent[i][J][k][L] =
            (i == k && J == L ? 2. * by_I : 0.) + by_J * permutation + 4. * by_II * F[i][J] * F[k][L] +
            2. * by_IJ * (F[i][J] * cof[k][L] + cof[i][J] * F[k][L]) + by_JJ * cof[i][J] * cof[k][L];
        }
  return result;
}

StretchMeans stretch_means(const double I, const double J)
{
  const double x = I / (2. * J);
  const auto [p, D, d] = legendre_quotients(x);
  const double q = p * (1. + (x - 1.) * D);
  // Derivatives of p and q by x, eq. (C.53): sums of terms of one sign.
  const double once = p / (2. * (x + 1.));
  const double twice = once / (2. * (x + 1.));
  const double p1 = -once * (1. - D);
  const double q1 = once * (1. + x * D);
  const double p2 = twice * (3. - 4. * D + 4. * d);
  const double q2 = -twice * (3. * (1. - D) + x * (D - 4. * d));

  // eq. (C.54)
  const double root = std::sqrt(J);
  const double root3 = J * root;
  const double root5 = J * root3;
  return {InvariantFunction({root * q, 0.5 * q1 / root, -p1 / root, 0.25 * q2 / root3, -0.5 * p2 / root3,
                             twice * ((x - 1.) * (2. - 3. * D + 6. * d) + 4. * d) / root3}),
          InvariantFunction({p / root, 0.5 * p1 / root3, -q1 / root3, 0.25 * p2 / root5, -0.5 * q2 / root5,
                             twice * (3. + 2. * x * (3. * D + x * (D + 2. * d))) / root5})};
}
} // namespace latcon::continuum
