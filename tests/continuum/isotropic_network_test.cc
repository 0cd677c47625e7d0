// Isotropic network law, compared with sums over directions, with Legendre functions to 40 digits, and with the
// triangular network of which it is the mean.
#include "continuum/isotropic_network.h"
#include "continuum/plane_invariants.h"
#include "material_checks.h"

#include <array>

namespace isotropic_network_test
{

using namespace latcon;
using namespace material_checks;
using continuum::CauchyBorn;
using continuum::FibreFamily;
using continuum::IsotropicNetwork;

// Rods with two ratios of their constants, and springs; directions are irrelevant.
std::vector<FibreFamily> mixed_families()
{
  const Tensor<1, 2> x({1., 0.});
  return {{x, 0.7, continuum::RodPotential{1e5, 1.5e5}},
          {x, 1.1, continuum::LinearPotential{2e5}},
          {x, 0.4, continuum::RodPotential{2e5, -0.5e5}}};
}

IsotropicNetwork mixed_network()
{
  return IsotropicNetwork(mixed_families());
}

// Returns these fibres, each in n directions over half a turn.
CauchyBorn in_directions(const std::vector<FibreFamily> &families, const unsigned int n, const double first = 0.3)
{
  std::vector<FibreFamily> turned;
  for (const FibreFamily &family : families)
    for (unsigned int k = 0; k < n; ++k)
    {
      const double angle = first + pi * k / n;
      turned.push_back({Tensor<1, 2>({std::cos(angle), std::sin(angle)}), family.weight / n, family.potential});
    }
  return CauchyBorn(turned);
}

// Lattice of the paper with the area factors of quick.prm, rows along x.
CauchyBorn quick_network()
{
  std::vector<FibreFamily> families;
  for (int k = 0; k < 6; ++k)
    families.push_back({Tensor<1, 2>({std::cos(pi * k / 6.), std::sin(pi * k / 6.)}),
                        k % 2 == 0 ? 0.72 : std::sqrt(3.) * 0.81, continuum::RodPotential{1e5, 1.5e5}});
  return CauchyBorn(families);
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
    for (const FibreFamily &family : mixed_families())
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

TEST(IsotropicNetwork, SumsOverDirectionsConvergeGeometrically)
{
  // Per direction the error decreases by (l1 - l2)/(l1 + l2), apart from a power of n, which costs less than 10 % of a
  // digit per direction here.
  const IsotropicNetwork law = mixed_network();
  for (const auto &[l1, l2] : {std::pair{2.3, 1.}, std::pair{2.8, 1.}, std::pair{2.8, 0.6}})
  {
    const Tensor<2, 2> F = matrix(l1, 0., 0., l2);
    const auto error = [&](const unsigned int n)
    { return std::abs(in_directions(mixed_families(), n, 0.).energy(F) - law.energy(F)); };
    const double observed = std::pow(error(24) / error(12), 1. / 12.);
    EXPECT_NEAR(std::log10(observed), std::log10((l1 - l2) / (l1 + l2)), 0.1);
  }
}

// theory-continuum.md, eqs. (C.51) to (C.54), at J = 1, where I = 2 x: P_{1/2}(x) and P_{-1/2}(x) as hypergeometric
// series in 40 digits.
TEST(StretchMeans, AreLegendreFunctions)
{
  struct Case
  {
    double x;
    std::array<double, 6> stretch, inverse; // value, by I, by J, by II, by IJ, by JJ
  };
  const std::vector<Case> cases = {{1.0,
                                    {1.0, 0.1875, 0.125, -0.029296875, -0.03515625, 0.0078125},
                                    {1.0, -0.0625, -0.375, 0.017578125, 0.05859375, 0.4453125}},
                                   {1.0000000001,
                                    {1.0000000000375, 0.187499999994140625, 0.124999999992968749,
                                     -0.0292968749974365232, -0.0351562499963378903, 0.00781250000322265652},
                                    {0.999999999987499999, -0.0624999999964843747, -0.374999999988281249,
                                     0.0175781249981689452, 0.0585937499948730465, 0.44531249998095703}},
                                   {1.25,
                                    {1.09033350140029417, 0.174286117779711182, 0.10945145625086913,
                                     -0.023857983488149014, -0.0274981001694830559, 0.0140195222982730746},
                                    {0.970773111746017553, -0.0547257281254345652, -0.348572235559422363,
                                     0.013749050084741528, 0.0477159669762980279, 0.403568435898388475}},
                                   {2.6,
                                    {1.49541627388772166, 0.13148350488527741, 0.0639939115404182726,
                                     -0.0106712780117662261, -0.0102511067814543275, 0.0213087994933533683},
                                    {0.858702359551284669, -0.0319969557702091363, -0.26296700977055482,
                                     0.00512555339072716373, 0.0213425560235324522, 0.283469223333463475}},
                                   {50.005,
                                    {6.36794576972086153, 0.0318111310871745546, 0.00254166483210339815,
                                     -0.000158722054100200342, -0.000031772913026240333, 0.00190677661570259679},
                                    {0.381436424207359081, -0.00127083241605169908, -0.0636222621743491092,
                                     0.0000158864565131201665, 0.000317444108200400683, 0.0636858080004015899}},
                                   {5000.00005,
                                    {63.6619804506167961, 0.00318309844342107812, 5.47278777482323852e-6,
                                     -1.59154844853883398e-7, -7.57256220709370265e-10, 4.83616839540770493e-6},
                                    {0.0674602720691954713, -2.73639388741161926e-6, -0.00636619688684215623,
                                     3.78628110354685133e-10, 3.18309689707766795e-7, 0.00636619840135459765}},
                                   {500000000000.0,
                                    {636619.772367581343, 3.18309886183790672e-7, 1.71997572289817095e-17,
                                     -1.59154943091895336e-19, -2.51630160711049829e-29, 1.65631374566141281e-17},
                                    {0.0000184729967737168722, -8.59987861449085473e-18, -6.36619772367581343e-7,
                                     1.25815080355524914e-29, 3.18309886183790672e-19, 6.36619772367581343e-7}}};
  for (const auto &[x, stretch, inverse] : cases)
  {
    const continuum::StretchMeans mean = continuum::stretch_means(2. * x, 1.);
    const auto expect = [x = x](const continuum::InvariantFunction &f, const std::array<double, 6> &digits)
    {
      const std::array<double, 6> values = {f.value, f.by_I, f.by_J, f.by_II, f.by_IJ, f.by_JJ};
      // About ten operations on an arithmetic-geometric mean that has several rounding errors itself.
      for (unsigned int k = 0; k < 6; ++k)
        EXPECT_NEAR(values[k] / digits[k], 1., 16. * epsilon) << "x = " << x << ", derivative " << k;
    };
    expect(mean.stretch, stretch);
    expect(mean.inverse, inverse);
  }
}

// Homogeneous of degrees 1 and -1 in the stretches, hence 1/2 and -1/2 in the invariants.
TEST(StretchMeans, AreHomogeneous)
{
  for (const auto &[I, J] : {std::pair{2., 1.}, std::pair{5.3, 2.1}, std::pair{7., 0.01}})
  {
    const continuum::StretchMeans mean = continuum::stretch_means(I, J);
    EXPECT_NEAR(I * mean.stretch.by_I + J * mean.stretch.by_J, 0.5 * mean.stretch.value, 8. * epsilon * I);
    EXPECT_NEAR(I * mean.inverse.by_I + J * mean.inverse.by_J, -0.5 * mean.inverse.value, 8. * epsilon * I);
  }
}

// theory-comparison.md, eq. (H.2).
TEST(IsotropicNetwork, HasTheModuliOfTheLattice)
{
  const double mu = 2. / 3. * 9. / 8. * (1. + std::sqrt(3.)) * 2.5e5;
  expect_isotropic_moduli(IsotropicNetwork(rubber_network().families()), mu, mu);
  expect_isotropic_moduli(IsotropicNetwork({{Tensor<1, 2>({0., 1.}), 2., continuum::LinearPotential{8e5}}}), 2e5, 2e5);
}

// The mean omits the sixfold anisotropy of the triangular lattice: zero under equal stretches, and elsewhere the result
// of an independent script, to two digits.
TEST(IsotropicNetwork, MissesTheLatticeByItsAnisotropyAlone)
{
  const CauchyBorn lattice = quick_network();
  const IsotropicNetwork law(lattice.families());
  const auto expect_two_digits = [](const double value, const double digits)
  { EXPECT_NEAR(value / digits, 1., 0.05) << value; };
  struct Case
  {
    double x, y, energy, stress;
  };
  for (const auto &[x, y, energy, stress] :
       {Case{1.3, 1.1, 1.8e-3, 6.7e-3}, Case{1.5, 2., 3.9e-4, 2.4e-3}, Case{2.3, 2.8, 1.3e-7, 3.8e-5},
        Case{1., 2.8, 5.2e-3, 1.5e-2}, Case{1., 3.5, 1.3e-3, 5.5e-3}, Case{2.3, 1., 1.3e-2, 5.3e-2},
        Case{0.6, 2.8, 5.2e-3, 6.5e-2}})
  {
    const Tensor<2, 2> F = matrix(x, 0., 0., y);
    SCOPED_TRACE(testing::Message() << "F = diag(" << x << ", " << y << ")");
    expect_two_digits(std::abs(law.energy(F) / lattice.energy(F) - 1.), energy);
    const Tensor<2, 2> P = lattice.first_piola_stress(F);
    expect_two_digits((law.first_piola_stress(F) - P).norm() / P.norm(), stress);
  }
  const Tensor<2, 2> F = matrix(1.9, 0., 0., 1.9);
  EXPECT_NEAR(law.energy(F), lattice.energy(F), 20. * epsilon * lattice.energy(F));
  EXPECT_NEAR((law.first_piola_stress(F) - lattice.first_piola_stress(F)).norm(), 0.,
              20. * epsilon * lattice.first_piola_stress(F).norm());
}

TEST(IsotropicNetwork, RefusesWhatIsNoNetwork)
{
  const Tensor<1, 2> x({1., 0.});
  EXPECT_THROW(IsotropicNetwork({}), continuum::InvalidMaterial);
  EXPECT_THROW(IsotropicNetwork({{x, -1., continuum::LinearPotential{1.}}}), continuum::InvalidMaterial);
  EXPECT_THROW(IsotropicNetwork({{x, 1., continuum::RodPotential{1., -1.}}}), continuum::InvalidMaterial);
}

} // namespace isotropic_network_test
