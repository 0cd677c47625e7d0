// Gradient laws alone: forms and their derivatives against automatic differentiation of the energy as theory.md,
// section 4, writes it, symmetries, and the dispersion of the lattice.
#include "continuum/errors.h"
#include "sheets.h"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <array>
#include <limits>

using namespace sheets;
using continuum::BondFamily;
using continuum::GradientLaw;
using continuum::IsotropicGradient;
using continuum::LatticeGradient;

namespace
{
using Gradient = GradientLaw::Gradient;
using Fad = Sacado::Fad::DFad<double>;
using FadFad = Sacado::Fad::DFad<Fad>;

const double epsilon = std::numeric_limits<double>::epsilon();
constexpr double spacing = 0.625e-3;

// F_11 F_12 F_21 F_22, then G_i11 G_i22 G_i12 for i = 1, 2.
constexpr unsigned int n_variables = 10;
constexpr unsigned int place[2][2] = {{0, 2}, {2, 1}};
unsigned int variable(const unsigned int i, const unsigned int J)
{
  return 2 * i + J;
}
unsigned int variable(const unsigned int i, const unsigned int J, const unsigned int K)
{
  return 4 + 3 * i + place[J][K];
}

// Sum over the bonds of c/2 [ l_d^2 (G_.JK N_K).H.(G_.JL N_L) - (l^2/12) (G:NN).H.(G:NN) ], with the bond's own
// stiffness H = psi'' n n + (psi'/stretch) (I - n n).
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
    if (const auto *rod = std::get_if<continuum::RodPotential>(&bond.fibre.potential))
    {
      psi1 = rod->a * (stretch - 1. / (stretch * stretch)) + rod->b * (1. - 1. / (stretch * stretch * stretch));
      psi2 = rod->a * (1. + 2. / (stretch * stretch * stretch)) + 3. * rod->b / (stretch * stretch * stretch * stretch);
    }
    else
    {
      const double e = std::get<continuum::LinearPotential>(bond.fibre.potential).e;
      psi1 = e * (stretch - 1.);
      psi2 = e;
    }
    const auto h = [&](const Number(&a)[2]) -> Number
    {
      const Number along = a[0] * n[0] + a[1] * n[1];
      return psi2 * along * along + psi1 / stretch * (a[0] * a[0] + a[1] * a[1] - along * along);
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

template <typename Number>
Number isotropic_energy(const double modulus, const std::array<Number, n_variables> &v)
{
  Number W(0.);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
        W += 0.5 * modulus * v[variable(i, J, K)] * v[variable(i, J, K)];
  return W;
}

std::vector<BondFamily> mixed_bonds()
{
  return {{{Tensor<1, 2>({1., 0.}), 0.7, continuum::RodPotential{1e5, 1.5e5}}, 1.3 * spacing},
          {{Tensor<1, 2>({0.6, 0.8}), 1.1, continuum::LinearPotential{2e5}}, 0.8 * spacing},
          {{Tensor<1, 2>({-0.28, 0.96}), 0.4, continuum::RodPotential{2e5, -0.5e5}}, spacing}};
}

// Value, first and second derivatives of an energy by the ten variables.
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

// A sum of some hundred terms, each good to a few roundings; scale is what they are made of.
constexpr double roundings = 300.;

template <typename Energy>
void expect_derivatives(const GradientLaw &law, const Energy &energy)
{
  std::mt19937 generator(3);
  for (int sample = 0; sample < 30; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator, 0.8, 3.);
    const Gradient G = random_gradient(generator, spacing);
    const Gradient Z = random_gradient(generator, spacing);
    const FadFad at_G = differentiated(energy, F, G);
    const FadFad at_Z = differentiated(energy, F, Z);
    const FadFad at_sum = differentiated(energy, F, G + Z);
    const FadFad form = at_sum - at_G - at_Z; // W(G + Z) - W(G) - W(Z) = B(G, Z)
    const double tolerance = roundings * epsilon * at_sum.val().val();
    const double per_G = spacing; // derivatives by G are larger by the inverse of what G is made of

    EXPECT_NEAR(law.energy(F, G), at_G.val().val(), tolerance);
    EXPECT_NEAR(law.form(F, G, Z), form.val().val(), tolerance);
    const Tensor<2, 2> P = law.first_piola_stress(F, G);
    const Tensor<2, 2> form_by_F = law.form_by_F(F, G, Z);
    const Gradient Q = law.double_stress(F, G);
    const Tensor<4, 2> T = law.tangent(F, G);
    const Tensor<4, 2> form_by_FF = law.form_by_FF(F, G, Z);
    const Tensor<5, 2> Q_by_F = law.double_stress_by_F(F, G);
    const Tensor<6, 2> Q_by_G = law.double_stress_by_G(F);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        EXPECT_NEAR(P[i][J], at_G.dx(variable(i, J)).val(), 10. * tolerance);
        EXPECT_NEAR(form_by_F[i][J], form.dx(variable(i, J)).val(), 10. * tolerance);
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
          {
            EXPECT_NEAR(T[i][J][k][L], at_G.dx(variable(i, J)).dx(variable(k, L)), 100. * tolerance);
            EXPECT_NEAR(form_by_FF[i][J][k][L], form.dx(variable(i, J)).dx(variable(k, L)), 100. * tolerance);
          }
        for (unsigned int K = 0; K < 2; ++K)
        {
          // One variable stands for G_i12 and G_i21.
          const double half = J == K ? 1. : 0.5;
          const auto by_Q = at_G.dx(variable(i, J, K));
          EXPECT_NEAR(Q[i][J][K], half * by_Q.val(), 10. * per_G * tolerance);
          for (unsigned int l = 0; l < 2; ++l)
            for (unsigned int M = 0; M < 2; ++M)
            {
              EXPECT_NEAR(Q_by_F[i][J][K][l][M], half * by_Q.dx(variable(l, M)), 100. * per_G * tolerance);
              for (unsigned int N = 0; N < 2; ++N)
                EXPECT_NEAR(Q_by_G[i][J][K][l][M][N], half * (M == N ? 1. : 0.5) * by_Q.dx(variable(l, M, N)),
                            100. * per_G * per_G * tolerance);
            }
        }
      }
  }
}

Gradient rotated(const Tensor<2, 2> &R, const Gradient &G)
{
  Gradient result;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int j = 0; j < 2; ++j)
      result[i] += R[i][j] * G[j];
  return result;
}

// G seen from a reference configuration turned by R.
Gradient turned(const Gradient &G, const Tensor<2, 2> &R)
{
  Gradient result;
  for (unsigned int i = 0; i < 2; ++i)
    result[i] = R * G[i] * transpose(R);
  return result;
}

void expect_objective(const GradientLaw &law)
{
  std::mt19937 generator(5);
  for (int sample = 0; sample < 30; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Gradient G = random_gradient(generator, spacing);
    const Gradient Z = random_gradient(generator, spacing);
    const Tensor<2, 2> R = rotation(0.1 + 0.2 * sample);
    const double scale = law.energy(F, G) + law.energy(F, Z);
    EXPECT_NEAR(law.form(R * F, rotated(R, G), rotated(R, Z)), law.form(F, G, Z), roundings * epsilon * scale);
    EXPECT_NEAR((law.first_piola_stress(R * F, rotated(R, G)) - R * law.first_piola_stress(F, G)).norm(), 0.,
                10. * roundings * epsilon * scale);
    EXPECT_NEAR((law.double_stress(R * F, rotated(R, G)) - rotated(R, law.double_stress(F, G))).norm(), 0.,
                10. * roundings * epsilon * scale * spacing);
  }
}

// n . A . n with A from the second normal derivative, over the mass: coefficient of k^4 in w^2 that the law adds.
double symbol(const GradientLaw &law, const Tensor<2, 2> &F, const Tensor<1, 2> &k, const Tensor<1, 2> &p)
{
  const Gradient G = outer_product(p, outer_product(k, k));
  return law.form(F, G, G);
}
} // namespace

// theory-continuum.md, eqs. (C.20) and (C.22) to (C.24).
TEST(LatticeGradient, FormsAreDerivativesOfTheEnergy)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  expect_derivatives(LatticeGradient(bonds, l_d), [&](const auto &v) { return lattice_energy(bonds, l_d, v); });
}

// theory-continuum.md, eq. (C.21).
TEST(IsotropicGradient, FormsAreDerivativesOfTheEnergy)
{
  expect_derivatives(IsotropicGradient(5e5, 0.4 * spacing),
                     [](const auto &v) { return isotropic_energy(5e5 * 0.16 * spacing * spacing, v); });
}

TEST(LatticeGradient, IsObjective)
{
  expect_objective(rubber_gradient(spacing));
}

TEST(IsotropicGradient, IsObjective)
{
  expect_objective(IsotropicGradient(5e5, spacing));
}

TEST(GradientLaw, VanishesInHomogeneousDeformation)
{
  const LatticeGradient lattice = rubber_gradient(spacing);
  const IsotropicGradient isotropic(5e5, spacing);
  for (const GradientLaw *law :
       {static_cast<const GradientLaw *>(&lattice), static_cast<const GradientLaw *>(&isotropic)})
  {
    const Tensor<2, 2> F = matrix(2.3, 0.1, -0.2, 2.8);
    EXPECT_EQ(law->energy(F, Gradient()), 0.);
    EXPECT_EQ(law->first_piola_stress(F, Gradient()).norm(), 0.);
    EXPECT_EQ(law->double_stress(F, Gradient()).norm(), 0.);
    EXPECT_EQ(law->tangent(F, Gradient()).norm(), 0.);
  }
}

TEST(LatticeGradient, IsHexagonalAndNotIsotropic)
{
  const LatticeGradient law = rubber_gradient(spacing);
  std::mt19937 generator(8);
  double largest_difference = 0.;
  for (int sample = 0; sample < 30; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Gradient G = random_gradient(generator, spacing);
    const double W = law.energy(F, G);
    const Tensor<2, 2> sixth = rotation(pi / 3.);
    EXPECT_NEAR(law.energy(F * transpose(sixth), turned(G, sixth)), W, roundings * epsilon * W);
    const Tensor<2, 2> twelfth = rotation(pi / 6.);
    largest_difference =
      std::max(largest_difference, std::abs(law.energy(F * transpose(twelfth), turned(G, twelfth)) / W - 1.));
  }
  EXPECT_GT(largest_difference, 0.01);
}

// Bonds in tension have stiffness along and across; at l_d = d/2 the energy is at the edge of positivity.
// theory-continuum.md, eqs. (C.25) and (C.26).
TEST(LatticeGradient, IsPositiveInTension)
{
  const LatticeGradient law = rubber_gradient(spacing);
  EXPECT_NEAR(LatticeGradient::smallest_length(rubber_bonds(spacing)), 0.5 * spacing, 10. * epsilon * spacing);
  std::mt19937 generator(9);
  for (int sample = 0; sample < 200; ++sample)
    EXPECT_GT(law.energy(random_deformation(generator, 1.01, 3.), random_gradient(generator, spacing)), 0.);
}

// A strip pulled along y and free across: bonds along x are compressed, and push their ends apart across themselves.
// The lateral stretches make P_xx = 0 in the local law; a wave that alternates along x is resisted no longer
// beyond 2.2.
TEST(LatticeGradient, LosesPositivityWhereBondsAreCompressed)
{
  const LatticeGradient law = rubber_gradient(spacing);
  const continuum::CauchyBorn local = rubber_network();
  const auto softest = [&](const double lateral, const double stretch)
  {
    const Tensor<2, 2> F = matrix(lateral, 0., 0., stretch);
    EXPECT_LT(std::abs(local.first_piola_stress(F)[0][0]), 1e3); // of 5e5 Pa: the three digits of the stretch
    double least = std::numeric_limits<double>::infinity();
    for (int n = 0; n < 180; ++n)
      for (int p = 0; p < 180; ++p)
        least = std::min(least, symbol(law, F, Tensor<1, 2>({std::cos(n * pi / 180.), std::sin(n * pi / 180.)}),
                                       Tensor<1, 2>({std::cos(p * pi / 180.), std::sin(p * pi / 180.)})));
    return least;
  };
  EXPECT_GT(softest(0.779, 2.), 0.);
  EXPECT_LT(softest(0.747, 2.5), 0.);
}

// theory-continuum.md, eq. (C.47): alpha d^2 = l_d^2 - H/A2, with A2 = rho c^2 from the Cauchy-Born law and H from the
// gradient law.
TEST(LatticeGradient, HasTheDispersionOfTheLattice)
{
  const LatticeGradient law = rubber_gradient(spacing);
  const continuum::CauchyBorn local = rubber_network();
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  const Tensor<1, 2> x({1., 0.}), y({0., 1.});
  const auto alpha = [&](const Tensor<1, 2> &k, const Tensor<1, 2> &p)
  {
    const double A2 = scalar_product(
      outer_product(p, k), dealii::double_contract<2, 0, 3, 1>(local.tangent(I), Tensor<2, 2>(outer_product(p, k))));
    return 0.25 - symbol(law, I, k, p) / A2 / (spacing * spacing);
  };
  // Seven digits are given.
  EXPECT_NEAR(alpha(x, y), 0.1264958, 5.1e-8);
  EXPECT_NEAR(alpha(x, x), 0.1468305, 5.1e-8);
  EXPECT_NEAR(alpha(y, x), 0.0625, 5.1e-8);
  EXPECT_NEAR(alpha(y, y), 0.1681624, 5.1e-8);
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
  // The scan misses the largest by the square of its step at most.
  EXPECT_NEAR(law.normal_stiffness(), largest, 1e-3 * largest);
}

TEST(LatticeGradient, RefusesWhatIsNotPositive)
{
  const auto bonds = rubber_bonds(spacing);
  EXPECT_NO_THROW(LatticeGradient(bonds, 0.5 * spacing));
  EXPECT_THROW(LatticeGradient(bonds, 0.499 * spacing), continuum::InvalidMaterial);
  EXPECT_THROW(LatticeGradient({}, spacing), continuum::InvalidMaterial);
  auto broken = bonds;
  broken[0].length = 0.;
  EXPECT_THROW(LatticeGradient(broken, spacing), continuum::InvalidMaterial);
  broken = bonds;
  broken[0].fibre.weight = -1.;
  EXPECT_THROW(LatticeGradient(broken, spacing), continuum::InvalidMaterial);
  EXPECT_THROW(IsotropicGradient(0., 1.), continuum::InvalidMaterial);
  EXPECT_THROW(IsotropicGradient(1., -1.), continuum::InvalidMaterial);
  EXPECT_THROW(rubber_gradient(spacing).energy(matrix(1., 0., 0., -1.), Gradient()), continuum::NonPhysicalState);
}
