// Gradient laws: energies and their derivatives, compared with automatic differentiation of the energy in the form of
// theory-continuum.md, eq. (C.22), which has the symmetries of its bonds; positivity, and the mean over all directions.
#include "continuum/errors.h"
#include "continuum/network_gradient.h"
#include "energies.h"

#include <gtest/gtest.h>

#include <tuple>

namespace gradient_laws_test
{

using namespace latcon;
using namespace energies;
using continuum::BondFamily;
using continuum::GradientLaw;
using continuum::IsotropicGradient;
using continuum::LatticeGradient;
using continuum::NetworkGradient;
using continuum::Order;

using Gradient = GradientLaw::Gradient;

constexpr double spacing = 0.625e-3;

std::vector<BondFamily> mixed_bonds()
{
  return {{{Tensor<1, 2>({1., 0.}), 0.7, continuum::RodPotential{1e5, 1.5e5}}, 1.3 * spacing},
          {{Tensor<1, 2>({0.6, 0.8}), 1.1, continuum::LinearPotential{2e5}}, 0.8 * spacing},
          {{Tensor<1, 2>({-0.28, 0.96}), 0.4, continuum::RodPotential{2e5, -0.5e5}}, spacing}};
}

// Computes value, first and second derivatives of an energy by the ten variables.
template <typename Energy>
FadFad differentiated(const Energy &energy, const Tensor<2, 2> &F, const Gradient &G)
{
  Variables<FadFad> v;
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

// Returns n . A . n with A from the second normal derivative, divided by the mass: contribution of the law to the
// coefficient of k^4 in w^2.
double symbol(const GradientLaw &law, const Tensor<2, 2> &F, const Tensor<1, 2> &k, const Tensor<1, 2> &p)
{
  const Gradient G = outer_product(p, outer_product(k, k));
  return 2. * law.energy(F, G);
}

// Returns these bonds, each in n directions over half a turn.
std::vector<BondFamily> in_directions(const std::vector<BondFamily> &bonds, const unsigned int n)
{
  std::vector<BondFamily> turned;
  for (BondFamily bond : bonds)
    for (unsigned int k = 0; k < n; ++k)
    {
      bond.fibre.direction = Tensor<1, 2>({std::cos(pi * k / n), std::sin(pi * k / n)});
      turned.push_back(bond);
      turned.back().fibre.weight /= n;
    }
  return turned;
}

// At any stretch and, where the energy varies on the scale of this interval, with every bond between rest and full
// stretch. theory-continuum.md, eqs. (C.20), (C.22) to (C.24) and (C.27).
TEST(LatticeGradient, FormsAreDerivativesOfTheEnergy)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  constexpr double full = LatticeGradient::full_stretch;
  expect_derivatives(LatticeGradient(bonds, l_d), LatticeGradientEnergy{bonds, l_d});
  expect_derivatives(LatticeGradient(bonds, l_d), LatticeGradientEnergy{bonds, l_d}, 1., full, 1. / (full - 1.));
}

// theory-continuum.md, eq. (C.21).
TEST(IsotropicGradient, FormsAreDerivativesOfTheEnergy)
{
  expect_derivatives(IsotropicGradient(5e5, 0.4 * spacing), IsotropicGradientEnergy{5e5 * 0.16 * spacing * spacing});
}

// theory-continuum.md, eqs. (C.25) to (C.27). At l_d = d/2 the energy is at the limit of positivity. Bonds in
// compression have a negative transverse stiffness, which the energy omits; it therefore stays positive for all bonds.
TEST(LatticeGradient, IsPositiveUnderCompression)
{
  const LatticeGradient law = rubber_gradient(spacing);
  const auto bonds = rubber_bonds(spacing);
  const NetworkGradient network(bonds, LatticeGradient::smallest_length(bonds));
  std::mt19937 generator(10);
  for (int sample = 0; sample < 200; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator, 0.3, 3.);
    const Gradient G = random_gradient(generator, spacing);
    EXPECT_GT(law.energy(F, G), 0.);
    EXPECT_GT(network.energy(F, G), 0.);
  }
  // A strip pulled along y and free across, with P_xx = 0 in the local law, has the stretch 0.747 along x at 2.5 along
  // y. With bonds in compression a wave along x would gain energy there.
  const Tensor<2, 2> F = matrix(0.747, 0., 0., 2.5);
  EXPECT_LT(std::abs(rubber_network().first_piola_stress(F)[0][0]),
            1e3); // compared with 5e5 Pa: three digits of the stretch
  for (int n = 0; n < 180; ++n)
    for (int p = 0; p < 180; ++p)
      EXPECT_GT(symbol(law, F, Tensor<1, 2>({std::cos(n * pi / 180.), std::sin(n * pi / 180.)}),
                       Tensor<1, 2>({std::cos(p * pi / 180.), std::sin(p * pi / 180.)})),
                0.);
}

TEST(GradientLaw, NormalStiffnessIsThatOfTheStiffestDirection)
{
  EXPECT_NEAR(IsotropicGradient(5e5, 2e-3).normal_stiffness(), 2., 1e-12);
  const LatticeGradient law = rubber_gradient(spacing);
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  double largest = 0.;
  for (int n = 0; n < 360; ++n)
    for (int p = 0; p < 360; ++p)
      largest = std::max(largest, symbol(law, I, Tensor<1, 2>({std::cos(n * pi / 360.), std::sin(n * pi / 360.)}),
                                         Tensor<1, 2>({std::cos(p * pi / 360.), std::sin(p * pi / 360.)})));
  // The error of the scan is at most of the order of the square of its step.
  EXPECT_NEAR(law.normal_stiffness(), largest, 1e-3 * largest);
}

// theory-continuum.md, eq. (C.25): mean of the lattice energy over all rotations of the reference configuration, here a
// sum over 64 directions of each bond. The 32 of the law differ from the mean by rho^32, rho = (l1 - l2)/(l1 + l2),
// times a power of 32 for the derivatives: by 5e-33 and 2e-11 times that.
TEST(NetworkGradient, IsTheMeanOfTheLatticeOverAllDirections)
{
  const auto bonds = rubber_bonds(spacing);
  const double l_d = LatticeGradient::smallest_length(bonds);
  const NetworkGradient law(bonds, l_d);
  const LatticeGradient sum(in_directions(bonds, 64), l_d);
  std::mt19937 generator(12);
  for (const auto &[l1, l2, digits] : {std::tuple{2.3, 2.8, 1e-12}, std::tuple{3., 1.1, 1e-7}})
  {
    const Tensor<2, 2> F = rotation(0.4) * matrix(l1, 0., 0., l2) * rotation(0.7);
    const Gradient G = random_gradient(generator, spacing);
    const auto W = law.evaluate(F, G, Order::second), mean = sum.evaluate(F, G, Order::second);
    EXPECT_NEAR(W.energy, mean.energy, digits * mean.energy);
    EXPECT_NEAR((W.first_piola - mean.first_piola).norm(), 0., 10. * digits * mean.energy);
    EXPECT_NEAR((W.double_stress - mean.double_stress).norm(), 0., digits * mean.double_stress.norm());
    EXPECT_NEAR((W.double_stress_by_G - mean.double_stress_by_G).norm(), 0., digits * mean.double_stress_by_G.norm());
  }
}

// Bonds with different potentials are not merged.
TEST(NetworkGradient, FormsAreDerivativesOfTheEnergy)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  expect_derivatives(NetworkGradient(bonds, l_d),
                     LatticeGradientEnergy{in_directions(bonds, NetworkGradient::n_directions), l_d});
}

// theory-continuum.md, eq. (C.58). With G_iJK = p_i delta_JK, G is completely along the bonds for every direction.
TEST(NetworkGradient, HasTheMeanSquaredLengthOfLikeBonds)
{
  const auto bonds = rubber_bonds(spacing);
  const double mean_square = (1. + 3. * std::sqrt(3.)) / (1. + std::sqrt(3.)) * spacing * spacing;
  const double least = (1. + 1e-12) * std::sqrt(mean_square / 12.);
  Gradient G;
  G[0][0][0] = G[0][1][1] = 0.1 / spacing;
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  const double mu = rubber_network().tangent(I)[0][1][0][1];
  EXPECT_NEAR(NetworkGradient(bonds, least).energy(I, G), 0., 100. * epsilon * mu);
  EXPECT_GT(NetworkGradient(bonds, 1.01 * least).energy(I, G), 1e-6 * mu);
  EXPECT_THROW(NetworkGradient(bonds, 0.999 * least), continuum::InvalidInput);
  // With a third potential on additional bonds, the longest mean determines the result.
  const double longest = 1.3 * spacing / std::sqrt(12.);
  EXPECT_NO_THROW(NetworkGradient(mixed_bonds(), (1. + 1e-12) * longest));
  EXPECT_THROW(NetworkGradient(mixed_bonds(), (1. - 1e-12) * longest), continuum::InvalidInput);
}

TEST(LatticeGradient, RefusesWhatIsNotPositive)
{
  const auto bonds = rubber_bonds(spacing);
  EXPECT_NO_THROW(LatticeGradient(bonds, 0.5 * spacing));
  EXPECT_THROW(LatticeGradient(bonds, 0.499 * spacing), continuum::InvalidInput);
  EXPECT_THROW(LatticeGradient({}, spacing), continuum::InvalidInput);
  auto broken = bonds;
  broken[0].length = 0.;
  EXPECT_THROW(LatticeGradient(broken, spacing), continuum::InvalidInput);
  broken = bonds;
  broken[0].fibre.weight = -1.;
  EXPECT_THROW(LatticeGradient(broken, spacing), continuum::InvalidInput);
  EXPECT_THROW(IsotropicGradient(0., 1.), continuum::InvalidInput);
  EXPECT_THROW(IsotropicGradient(1., -1.), continuum::InvalidInput);
  EXPECT_THROW(rubber_gradient(spacing).energy(matrix(1., 0., 0., -1.), Gradient()), continuum::NonPhysicalState);
}

} // namespace gradient_laws_test
