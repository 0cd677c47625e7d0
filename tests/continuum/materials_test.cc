// Laws: energy, stress and tangent, compared with automatic differentiation of the energies and, of the isotropic
// network, with sums over directions and with Legendre functions to 40 digits; moduli, wave speeds and refusals. What
// is equal to an energy of the same bonds, or of the same invariants, has its symmetries.
#include "continuum/errors.h"
#include "continuum/isotropic_network.h"
#include "continuum/plane_invariants.h"
#include "energies.h"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

namespace materials_test
{

using namespace latcon;
using namespace energies;
using continuum::CauchyBorn;
using continuum::FibreFamily;
using continuum::IsotropicNetwork;
using continuum::Material;
using continuum::MooneyRivlin;

// Compares with automatic differentiation of the energy; `cancellation` multiplies the round-off.
template <class Energy>
void expect_derivatives(const Material &law, const Energy &energy, const Tensor<2, 2> &F, const double cancellation)
{
  constexpr unsigned int n = 4;
  Variables<FadFad> v{};
  for (unsigned int k = 0; k < n; ++k)
    v[k] = FadFad(n, k, Fad(n, k, F[k / 2][k % 2]));
  const FadFad W = energy(v);
  const Tensor<2, 2> P = law.first_piola_stress(F);
  const Tensor<4, 2> T = law.tangent(F);
  // Both sides add tens of terms of the size of the tangent: 100 rounding errors of it, times the cancellation.
  const double tolerance = 100. * epsilon * T.norm();
  EXPECT_NEAR(law.energy(F), W.val().val(), tolerance * F.norm_square());
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
    {
      const Fad &by_F = W.dx(variable(i, J));
      EXPECT_NEAR(P[i][J], by_F.val(), cancellation * tolerance * F.norm());
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          EXPECT_NEAR(T[i][J][k][L], by_F.dx(variable(k, L)), cancellation * tolerance);
    }
}

void expect_isotropic_moduli(const Material &law, const double lambda, const double mu)
{
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  EXPECT_NEAR(law.energy(I), 0., 10. * epsilon * mu);
  EXPECT_NEAR(law.first_piola_stress(I).norm(), 0., 10. * epsilon * mu);
  const Tensor<4, 2> T = law.tangent(I);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          EXPECT_NEAR(T[i][J][k][L], lambda * I[i][J] * I[k][L] + mu * (I[i][k] * I[J][L] + I[i][L] * I[J][k]),
                      20. * epsilon * mu)
            << i << J << k << L;
}

// Returns the lower eigenvalue of Q(n) [Pa].
double lower_acoustic_eigenvalue(const Material &law, const Tensor<2, 2> &F, const Tensor<1, 2> &n)
{
  const Tensor<4, 2> T = law.tangent(F);
  Tensor<2, 2> Q;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int L = 0; L < 2; ++L)
          Q[i][k] += T[i][J][k][L] * n[J] * n[L];
  const double mean = 0.5 * trace(Q);
  return mean - std::sqrt(mean * mean - determinant(Q));
}

// Rods with two ratios of their constants, and springs.
const CauchyBorn mixed_network({{Tensor<1, 2>({1., 0.}), 0.7, continuum::RodPotential{1e5, 1.5e5}},
                                {Tensor<1, 2>({0.6, 0.8}), 1.1, continuum::LinearPotential{2e5}},
                                {Tensor<1, 2>({-0.28, 0.96}), 0.4, continuum::RodPotential{2e5, -0.5e5}}});

// theory-continuum.md, eqs. (C.4) to (C.8).
TEST(MooneyRivlin, AgreesWithDifferentiatedEnergy)
{
  for (const double ratio : {-0.05, 0.3})
  {
    const MooneyRivlin law = rubber_sheet(ratio);
    std::mt19937 generator(3);
    const MooneyRivlinEnergy energy{law.constants()};
    for (int sample = 0; sample < 100; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator);
      expect_derivatives(law, energy, F, 10.);
    }
  }
}

// theory-continuum.md, eqs. (C.1) and (C.11) to (C.14).
TEST(CauchyBorn, AgreesWithDifferentiatedEnergy)
{
  std::mt19937 generator(4);
  for (int sample = 0; sample < 100; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    expect_derivatives(mixed_network, NetworkEnergy{mixed_network.families()}, F, 1.);
  }
}

// theory-continuum.md, eq. (C.9).
TEST(MooneyRivlin, HasPlaneStressModuliAtIdentity)
{
  // Three-dimensional lambda = kappa + 4 c2, reduced by the free thickness.
  const double mu = 2. * (2e5 + 0.7e5);
  const double lambda_3d = 3e6 + 4. * 0.7e5;
  const double lambda = 2. * mu * lambda_3d / (lambda_3d + 2. * mu);
  const MooneyRivlin law({2e5, 0.7e5, 3e6});
  expect_isotropic_moduli(law, lambda, mu);
}

// theory-continuum.md, eq. (C.10).
TEST(MooneyRivlin, MatchesCauchyRelationForEveryRatio)
{
  for (const double ratio : {-0.5, -0.05, 0., 0.6})
    expect_isotropic_moduli(rubber_sheet(ratio), 5e5, 5e5);
}

// Returns these fibres, each in n directions over half a turn.
CauchyBorn in_directions(const std::vector<FibreFamily> &families, const unsigned int n)
{
  std::vector<FibreFamily> turned;
  for (const FibreFamily &family : families)
    for (unsigned int k = 0; k < n; ++k)
    {
      const double angle = 0.3 + pi * k / n;
      turned.push_back({Tensor<1, 2>({std::cos(angle), std::sin(angle)}), family.weight / n, family.potential});
    }
  return CauchyBorn(turned);
}

// theory-continuum.md, eqs. (C.50) to (C.56): a sum over n directions differs from the mean by the n-th power of (l1 -
// l2)/(l1 + l2), times a power of n for the derivatives.
TEST(IsotropicNetwork, IsTheMeanOverAllDirections)
{
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> angle(-pi, pi);
  for (const auto &[stretch, ratio, n] :
       {std::tuple{1., 1., 6u}, std::tuple{2., 1. + 1e-9, 6u}, std::tuple{0.8, 1.3, 40u}, std::tuple{1.5, 3., 100u},
        std::tuple{0.7, 10., 400u}, std::tuple{0.1, 100., 4000u}})
    for (const FibreFamily &family : mixed_network.families())
    {
      const Tensor<2, 2> F =
        rotation(angle(generator)) * matrix(stretch * ratio, 0., 0., stretch) * rotation(angle(generator));
      const IsotropicNetwork law({family});
      const CauchyBorn sum = in_directions({family}, n);
      // Both sides have rounding errors of tens of terms of the size of the tangent; a sum of n terms has sqrt(n) times
      // as many.
      const double tolerance = 20. * std::sqrt(n) * epsilon * sum.tangent(F).norm();
      EXPECT_NEAR(law.energy(F), sum.energy(F), tolerance * F.norm_square());
      EXPECT_NEAR((law.first_piola_stress(F) - sum.first_piola_stress(F)).norm(), 0., tolerance * F.norm());
      EXPECT_NEAR((law.tangent(F) - sum.tangent(F)).norm(), 0., tolerance);
    }
}

// theory-continuum.md, eqs. (C.51) to (C.54), at J = 1, where I = 2 x: P_{1/2}(x) and P_{-1/2}(x) as hypergeometric
// series in 40 digits, of stretches so different that no sum over directions has digits.
TEST(StretchMeans, AreLegendreFunctions)
{
  const continuum::StretchMeans mean = continuum::stretch_means(1e12, 1.);
  const auto expect = [](const continuum::InvariantFunction &f, const std::array<double, 6> &digits)
  {
    const std::array<double, 6> values = {f[0], f[1], f[2], f[3], f[4], f[5]};
    // About ten operations on an arithmetic-geometric mean that has several rounding errors itself.
    for (unsigned int k = 0; k < 6; ++k)
      EXPECT_NEAR(values[k] / digits[k], 1., 16. * epsilon) << "derivative " << k;
  };
  expect(mean.stretch, {636619.772367581343, 3.18309886183790672e-7, 1.71997572289817095e-17, -1.59154943091895336e-19,
                        -2.51630160711049829e-29, 1.65631374566141281e-17});
  expect(mean.inverse, {0.0000184729967737168722, -8.59987861449085473e-18, -6.36619772367581343e-7,
                        1.25815080355524914e-29, 3.18309886183790672e-19, 6.36619772367581343e-7});
}

// theory-comparison.md, eq. (H.2).
TEST(IsotropicNetwork, HasTheModuliOfTheLattice)
{
  const double mu = 2. / 3. * 9. / 8. * (1. + std::sqrt(3.)) * 2.5e5;
  expect_isotropic_moduli(IsotropicNetwork(rubber_network().families()), mu, mu);
  expect_isotropic_moduli(IsotropicNetwork({{Tensor<1, 2>({0., 1.}), 2., continuum::LinearPotential{8e5}}}), 2e5, 2e5);
}

// theory-continuum.md, eq. (C.3).
TEST(Material, MinimumAcousticEigenvalueIsTheLowestOverAllDirections)
{
  std::mt19937 generator(8);
  const MooneyRivlin law = rubber_sheet();
  for (int sample = 0; sample < 20; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    double lowest = std::numeric_limits<double>::infinity();
    const int n = 2000;
    for (int k = 0; k < n; ++k)
      lowest =
        std::min(lowest, lower_acoustic_eigenvalue(law, F, Tensor<1, 2>({std::cos(pi * k / n), std::sin(pi * k / n)})));
    // The error of a scan with step pi/n at a smooth minimum is about its curvature times (pi/n)^2/8, below 1e-6 of the
    // stiffness.
    const double found = continuum::minimum_acoustic_eigenvalue(law, F);
    EXPECT_LE(found, lowest * (1. + 1e-12));
    EXPECT_NEAR(found, lowest, 1e-6 * law.tangent(F).norm());
  }
}

TEST(Material, StrongEllipticityIsSeenToBeLost)
{
  // c2 < 0: at equibiaxial stretch the slow wave softens and becomes unstable while an equilibrium thickness still
  // exists.
  const MooneyRivlin law = rubber_sheet(-0.2);
  EXPECT_GT(continuum::minimum_acoustic_eigenvalue(law, matrix(1.5, 0., 0., 1.5)), 0.);
  EXPECT_LT(continuum::minimum_acoustic_eigenvalue(law, matrix(3., 0., 0., 0.7)), 0.);
}

// theory-continuum.md, eq. (C.2).
TEST(Material, CauchyStressIsForcePerCurrentLength)
{
  // Stretch (2, 3) with P = diag(6, 10): the edge of normal x is 3 times longer, that of normal y twice.
  const Tensor<2, 2> sigma = continuum::cauchy_stress(matrix(6., 0., 0., 10.), matrix(2., 0., 0., 3.));
  EXPECT_NEAR(sigma[0][0], 2., 4. * epsilon);
  EXPECT_NEAR(sigma[1][1], 5., 4. * epsilon);
  EXPECT_EQ(sigma[0][1], 0.);
}

TEST(Material, RefusesNonPositiveDeterminant)
{
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const MooneyRivlin rubber = rubber_sheet();
  const IsotropicNetwork mean(mixed_network.families());
  for (const Material *law : {static_cast<const Material *>(&mixed_network), static_cast<const Material *>(&rubber),
                              static_cast<const Material *>(&mean)})
  {
    for (const Tensor<2, 2> &F : {matrix(1., 0., 0., -1.25), matrix(1., 2., 2., 4.), matrix(nan, 0., 0., 1.),
                                  matrix(infinity, 0., 0., 1.), Tensor<2, 2>()})
    {
      EXPECT_THROW(law->energy(F), continuum::NonPhysicalState);
      EXPECT_THROW(law->first_piola_stress(F), continuum::NonPhysicalState);
      EXPECT_THROW(law->tangent(F), continuum::NonPhysicalState);
    }
    const std::string message =
      message_of<continuum::NonPhysicalState>([&] { law->energy(matrix(1., 0., 0., -1.25)); });
    EXPECT_NE(message.find("-1.25"), std::string::npos) << message;
  }
}

TEST(MooneyRivlin, RefusesStateWithoutThickness)
{
  // c1 + c2 |F|^2 + (kappa/2) (det F)^2 = 3e5 - 0.5e5 * 16.01 + 6e5 * 0.16 < 0: no root.
  const MooneyRivlin law = rubber_sheet(-0.2);
  EXPECT_THROW(law.energy(matrix(4., 0., 0., 0.1)), continuum::NonPhysicalState);
  EXPECT_NO_THROW(law.energy(matrix(4., 0., 0., 1.)));
}

TEST(MooneyRivlin, RefusesUnstableConstants)
{
  EXPECT_THROW(MooneyRivlin({1., -1., 1.}), continuum::InvalidInput);
  EXPECT_THROW(MooneyRivlin({1., 0., 0.}), continuum::InvalidInput);
  EXPECT_THROW(MooneyRivlin({1., 0., std::nan("")}), continuum::InvalidInput);
  EXPECT_THROW(MooneyRivlin({5., -4., 1.}), continuum::InvalidInput); // 4 c1 + 8 c2 + kappa = -11
  EXPECT_THROW(MooneyRivlin::Constants::with_equal_lame_constants(1., -1.), continuum::InvalidInput);
  EXPECT_NO_THROW(MooneyRivlin({1.05, -0.05, 4.2}));
}

TEST(CauchyBorn, RefusesUnstableFamilies)
{
  const Tensor<1, 2> x({1., 0.});
  EXPECT_THROW(CauchyBorn({}), continuum::InvalidInput);
  EXPECT_THROW(CauchyBorn({{Tensor<1, 2>({1., 1.}), 1., continuum::LinearPotential{1.}}}), continuum::InvalidInput);
  EXPECT_THROW(CauchyBorn({{x, 0., continuum::LinearPotential{1.}}}), continuum::InvalidInput);
  EXPECT_THROW(CauchyBorn({{x, 1., continuum::LinearPotential{-1.}}}), continuum::InvalidInput);
  EXPECT_THROW(CauchyBorn({{x, 1., continuum::RodPotential{1., -1.}}}), continuum::InvalidInput);
  EXPECT_THROW(IsotropicNetwork({}), continuum::InvalidInput);
  EXPECT_THROW(IsotropicNetwork({{x, -1., continuum::LinearPotential{1.}}}), continuum::InvalidInput);
  EXPECT_THROW(IsotropicNetwork({{x, 1., continuum::RodPotential{1., -1.}}}), continuum::InvalidInput);
}

} // namespace materials_test
