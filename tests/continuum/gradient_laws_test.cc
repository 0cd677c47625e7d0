// Gradient laws: forms and their derivatives, symmetries, positivity, and the dispersion of the lattice.
#include "continuum/network_gradient.h"
#include "gradient_checks.h"

namespace gradient_laws_test
{

using namespace latcon;
using namespace gradient_checks;
using continuum::IsotropicGradient;
using continuum::NetworkGradient;

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

// theory-continuum.md, eqs. (C.20) and (C.22) to (C.24).
TEST(LatticeGradient, FormsAreDerivativesOfTheEnergy)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  expect_derivatives(LatticeGradient(bonds, l_d), [&](const auto &v) { return lattice_energy(bonds, l_d, v); });
}

// theory-continuum.md, eq. (C.27): every bond is between rest and full stretch, where the energy varies on the scale of
// this interval.
TEST(LatticeGradient, FormsAreDerivativesOfTheEnergyWhereTensionBegins)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  constexpr double full = LatticeGradient::full_stretch;
  expect_derivatives(
    LatticeGradient(bonds, l_d), [&](const auto &v) { return lattice_energy(bonds, l_d, v); }, 1., full,
    1. / (full - 1.));
}

// The energy and its first two derivatives are continuous where bonds enter tension and where they reach full stretch.
TEST(LatticeGradient, IsTwiceContinuouslyDifferentiable)
{
  const LatticeGradient law = rubber_gradient(spacing);
  std::mt19937 generator(4);
  const Gradient G = random_gradient(generator, spacing);
  for (const double stretch : {1., LatticeGradient::full_stretch})
  {
    constexpr double step = 1e-9;
    const auto at = [&](const double l) { return matrix(l, 0., 0., l); };
    const Tensor<2, 2> below = at(stretch - step), above = at(stretch + step);
    // Third derivatives are up to 60 divided by the cube of the width of the transition, in units of the energy.
    const double tolerance = 60. / std::pow(LatticeGradient::full_stretch - 1., 3) * 2. * step * law.energy(above, G);
    const auto low = law.evaluate(below, G, Order::second), high = law.evaluate(above, G, Order::second);
    EXPECT_NEAR(low.energy, high.energy, tolerance);
    EXPECT_NEAR((low.first_piola - high.first_piola).norm(), 0., tolerance);
    EXPECT_NEAR((low.tangent - high.tangent).norm(), 0., tolerance);
    EXPECT_NEAR((low.double_stress_by_F - high.double_stress_by_F).norm(), 0., tolerance * spacing);
    EXPECT_NEAR((low.double_stress_by_G - high.double_stress_by_G).norm(), 0., tolerance * spacing * spacing);
  }
}

// theory-continuum.md, eq. (C.21).
TEST(IsotropicGradient, FormsAreDerivativesOfTheEnergy)
{
  expect_derivatives(IsotropicGradient(5e5, 0.4 * spacing),
                     [](const auto &v) { return isotropic_energy(5e5 * 0.16 * spacing * spacing, v); });
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
  // The error of the scan is at most of the order of the square of its step.
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

} // namespace gradient_laws_test
