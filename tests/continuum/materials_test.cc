// Laws: energy, stress and tangent, compared with automatic differentiation, moduli and wave speeds.
#include "material_checks.h"

#include <Sacado.hpp>

#include <array>

namespace materials_test
{

using namespace latcon;
using namespace material_checks;
using continuum::CauchyBorn;
using continuum::Material;
using continuum::MooneyRivlin;

using Fad = Sacado::Fad::DFad<double>;
using FadFad = Sacado::Fad::DFad<Fad>;
constexpr unsigned int n_variables = 5; // F_11, F_12, F_21, F_22, F_33

// Independent implementation of the energies from their definitions: the sheet from the full three-dimensional C, with
// variable F_33.
template <typename Number>
Number energy_in_3d(const MooneyRivlin::Constants &m, const std::array<Number, n_variables> &f)
{
  std::array<std::array<Number, 3>, 3> F;
  for (auto &row : F)
    row.fill(Number(0.));
  F[0][0] = f[0];
  F[0][1] = f[1];
  F[1][0] = f[2];
  F[1][1] = f[3];
  F[2][2] = f[4];
  Number trace(0.), trace_of_square(0.);
  for (int A = 0; A < 3; ++A)
    for (int B = 0; B < 3; ++B)
    {
      Number C(0.);
      for (int i = 0; i < 3; ++i)
        C += F[i][A] * F[i][B];
      if (A == B)
        trace += C;
      trace_of_square += C * C;
    }
  const Number I2 = 0.5 * (trace * trace - trace_of_square);
  const Number J = F[2][2] * (F[0][0] * F[1][1] - F[0][1] * F[1][0]);
  return m.c1 * (trace - 3. - 2. * log(J)) + m.c2 * (I2 - 3. - 4. * log(J)) + 0.5 * m.kappa * (J - 1.) * (J - 1.);
}

template <typename Number>
Number energy_of_network(const CauchyBorn &law, const std::array<Number, n_variables> &f)
{
  Number W(0.);
  for (const auto &family : law.families())
  {
    const Number x = f[0] * family.direction[0] + f[1] * family.direction[1];
    const Number y = f[2] * family.direction[0] + f[3] * family.direction[1];
    const Number l = sqrt(x * x + y * y);
    if (const auto *rod = std::get_if<continuum::RodPotential>(&family.potential))
      W += family.weight * (rod->a * (l * l / 2. + 1. / l - 1.5) + rod->b * (l + 1. / (2. * l * l) - 1.5));
    else
      W += family.weight * std::get<continuum::LinearPotential>(family.potential).e / 2. * (l - 1.) * (l - 1.);
  }
  return W;
}

struct Derivatives
{
  std::array<double, n_variables> first;
  std::array<std::array<double, n_variables>, n_variables> second;
};

template <typename Energy>
Derivatives differentiate(const Energy &energy, const Tensor<2, 2> &F, const double t)
{
  const std::array<double, n_variables> at = {F[0][0], F[0][1], F[1][0], F[1][1], t};
  std::array<FadFad, n_variables> f;
  for (unsigned int i = 0; i < n_variables; ++i)
    f[i] = FadFad(n_variables, i, Fad(n_variables, i, at[i]));
  const FadFad W = energy(f);
  Derivatives d{};
  for (unsigned int i = 0; i < n_variables; ++i)
  {
    d.first[i] = W.dx(i).val();
    for (unsigned int j = 0; j < n_variables; ++j)
      d.second[i][j] = W.dx(i).dx(j);
  }
  return d;
}

void expect_derivatives(const Material &law, const Tensor<2, 2> &F, const Derivatives &d, const double condition)
{
  const Tensor<2, 2> P = law.first_piola_stress(F);
  const Tensor<4, 2> T = law.tangent(F);
  // Both sides add tens of terms of the size of the tangent: 100 rounding errors of it, times the cancellation.
  const double tolerance = 100. * epsilon * condition * T.norm();
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
    {
      EXPECT_NEAR(P[i][J], d.first[2 * i + J], tolerance * F.norm());
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          EXPECT_NEAR(T[i][J][k][L], d.second[2 * i + J][2 * k + L], tolerance);
    }
}

// Returns the square roots of the eigenvalues of Q(n)/rho, ascending [m/s].
std::array<double, 2> wave_speeds(const Material &law, const Tensor<2, 2> &F, const Tensor<1, 2> &n, const double rho)
{
  const Tensor<4, 2> T = law.tangent(F);
  Tensor<2, 2> Q;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int L = 0; L < 2; ++L)
          Q[i][k] += T[i][J][k][L] * n[J] * n[L];
  const double mean = 0.5 * trace(Q);
  const double half = std::sqrt(mean * mean - determinant(Q));
  return {std::sqrt((mean - half) / rho), std::sqrt((mean + half) / rho)};
}

CauchyBorn mixed_network()
{
  return CauchyBorn({{Tensor<1, 2>({1., 0.}), 0.7, continuum::RodPotential{1e5, 1.5e5}},
                     {Tensor<1, 2>({0.6, 0.8}), 1.1, continuum::LinearPotential{2e5}},
                     {Tensor<1, 2>({-0.28, 0.96}), 0.4, continuum::RodPotential{2e5, -0.5e5}}});
}

// theory-continuum.md, eqs. (C.4) to (C.8).
TEST(MooneyRivlin, AgreesWithDifferentiatedThreeDimensionalEnergy)
{
  for (const double ratio : {-0.05, 0.3})
  {
    const MooneyRivlin law = rubber_sheet(ratio);
    std::mt19937 generator(3);
    for (int sample = 0; sample < 100; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator);
      const double t = law.thickness_stretch(F);
      const auto energy = [&](const auto &f) { return energy_in_3d(law.constants(), f); };
      Derivatives d = differentiate(energy, F, t);
      EXPECT_NEAR(law.energy(F), energy(std::array<double, n_variables>{F[0][0], F[0][1], F[1][0], F[1][1], t}),
                  100. * epsilon * law.tangent(F).norm() * F.norm_square());
      // The thickness is in equilibrium, and stable.
      EXPECT_NEAR(d.first[4], 0., 100. * epsilon * d.second[4][4]);
      EXPECT_GT(d.second[4][4], 0.);
      // Eliminate the thickness by minimisation.
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = 0; j < 4; ++j)
          d.second[i][j] -= d.second[i][4] * d.second[4][j] / d.second[4][4];
      expect_derivatives(law, F, d, 10.);
    }
  }
}

// theory-continuum.md, eqs. (C.1) and (C.11) to (C.14).
TEST(CauchyBorn, AgreesWithDifferentiatedEnergy)
{
  const CauchyBorn law = mixed_network();
  std::mt19937 generator(4);
  for (int sample = 0; sample < 100; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const auto energy = [&](const auto &f) { return energy_of_network(law, f); };
    EXPECT_NEAR(law.energy(F), energy(std::array<double, n_variables>{F[0][0], F[0][1], F[1][0], F[1][1], 1.}),
                100. * epsilon * law.tangent(F).norm() * F.norm_square());
    expect_derivatives(law, F, differentiate(energy, F, 1.), 1.);
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
  EXPECT_NEAR(law.shear_modulus(), mu, 4. * epsilon * mu);
  EXPECT_NEAR(law.lame_lambda(), lambda, 4. * epsilon * lambda);
}

// theory-continuum.md, eq. (C.10).
TEST(MooneyRivlin, MatchesCauchyRelationForEveryRatio)
{
  for (const double ratio : {-0.5, -0.05, 0., 0.6})
    expect_isotropic_moduli(rubber_sheet(ratio), 5e5, 5e5);
}

TEST(CauchyBorn, HasEqualLameConstantsAtIdentity)
{
  const double mu = 2. / 3. * 9. / 8. * (1. + std::sqrt(3.)) * 2.5e5;
  EXPECT_NEAR(mu / 2.5e5, 2.049038, 5e-7); // theory-comparison.md, eq. (H.2)
  expect_isotropic_moduli(rubber_network(), mu, mu);
}

TEST(CauchyBorn, HasTheWaveSpeedsOfTheTheory)
{
  // theory-comparison.md, eq. (W.2), evaluated independently to seven digits, so the tolerance is half a unit of the
  // last digit.
  const CauchyBorn law = rubber_network();
  const double rho = 944.;
  const Tensor<1, 2> x({1., 0.});
  const Tensor<1, 2> y({0., 1.});
  const auto expect_speeds = [&](const Tensor<2, 2> &F, const Tensor<1, 2> &n, const double slow, const double fast)
  {
    EXPECT_NEAR(wave_speeds(law, F, n, rho)[0], slow, 5.1e-6);
    EXPECT_NEAR(wave_speeds(law, F, n, rho)[1], fast, 5.1e-6);
  };
  expect_speeds(matrix(1., 0., 0., 1.), x, 23.29480, 40.34778);
  expect_speeds(matrix(2.3, 0., 0., 2.8), x, 19.76693, 20.31142);
  expect_speeds(matrix(2.3, 0., 0., 2.8), y, 19.00774, 20.31148);
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
    {
      const double speed = wave_speeds(law, F, Tensor<1, 2>({std::cos(pi * k / n), std::sin(pi * k / n)}), 1.)[0];
      lowest = std::min(lowest, speed * speed);
    }
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

TEST(MooneyRivlin, RefusesStateWithoutThickness)
{
  // c1 + c2 |F|^2 + (kappa/2) (det F)^2 = 3e5 - 0.5e5 * 16.01 + 6e5 * 0.16 < 0: no root.
  const MooneyRivlin law = rubber_sheet(-0.2);
  EXPECT_THROW(law.energy(matrix(4., 0., 0., 0.1)), continuum::NonPhysicalState);
  EXPECT_NO_THROW(law.energy(matrix(4., 0., 0., 1.)));
}

TEST(MooneyRivlin, RefusesUnstableConstants)
{
  EXPECT_THROW(MooneyRivlin({1., -1., 1.}), continuum::InvalidMaterial);
  EXPECT_THROW(MooneyRivlin({1., 0., 0.}), continuum::InvalidMaterial);
  EXPECT_THROW(MooneyRivlin({1., 0., std::nan("")}), continuum::InvalidMaterial);
  EXPECT_THROW(MooneyRivlin({5., -4., 1.}), continuum::InvalidMaterial); // 4 c1 + 8 c2 + kappa = -11
  EXPECT_THROW(MooneyRivlin::Constants::with_equal_lame_constants(1., -1.), continuum::InvalidMaterial);
  EXPECT_NO_THROW(MooneyRivlin({1.05, -0.05, 4.2}));
}

TEST(CauchyBorn, RefusesUnstableFamilies)
{
  const Tensor<1, 2> x({1., 0.});
  EXPECT_THROW(CauchyBorn({}), continuum::InvalidMaterial);
  EXPECT_THROW(CauchyBorn({{Tensor<1, 2>({1., 1.}), 1., continuum::LinearPotential{1.}}}), continuum::InvalidMaterial);
  EXPECT_THROW(CauchyBorn({{x, 0., continuum::LinearPotential{1.}}}), continuum::InvalidMaterial);
  EXPECT_THROW(CauchyBorn({{x, 1., continuum::LinearPotential{-1.}}}), continuum::InvalidMaterial);
  EXPECT_THROW(CauchyBorn({{x, 1., continuum::RodPotential{1., -1.}}}), continuum::InvalidMaterial);
}

} // namespace materials_test
