#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

namespace disorder_test
{

using namespace latcon::lattice;

using Kind = Distribution::Kind;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Moments
{
  double mean = 0., variance = 0., third = 0., fourth = 0.; // of the factor less 1; moments about 1
  double smallest = infinity, largest = -infinity;
};

Moments moments(const Distribution &distribution, std::uint64_t n)
{
  Moments sums;
  for (std::uint64_t key = 0; key < n; ++key)
  {
    const double factor = distribution.factor(key), x = factor - 1.;
    sums.mean += x / static_cast<double>(n);
    sums.variance += x * x / static_cast<double>(n);
    sums.third += x * x * x / static_cast<double>(n);
    sums.fourth += x * x * x * x / static_cast<double>(n);
    sums.smallest = std::min(sums.smallest, factor);
    sums.largest = std::max(sums.largest, factor);
  }
  return sums;
}

// theory.md, eq. (L.36): five standard errors of the mean and of the variance, by central limit; beyond with a
// probability of 6e-7. What tells the shapes apart: fourth moments over squared variances, and skewness, which
// Weibull's shapes have of either sign.
TEST(Distribution, HasMeanOneItsWidthAndItsShape)
{
  constexpr std::uint64_t n = 400000;
  const double root = std::sqrt(static_cast<double>(n));
  const struct
  {
    Kind kind;
    double width, kurtosis = 0., error = 0.; // if known
    int sign_of_skewness = 0;
  } distributions[] = {
    {Kind::uniform, 0.05},
    {Kind::uniform, 0.3, 1.8, 0.01},
    {Kind::normal, 0.02},
    // (3 (2 Phi(3) - 1) - (2 * 27 + 6 * 3) phi(3)) / (2 Phi(3) - 1) over the squared variance 0.97334.
    {Kind::normal, 0.2, 2.8287, 0.03},
    {Kind::weibull, 0.1, 0., 0., -1},
    {Kind::weibull, 0.6, 0., 0., 1},
    // Five standard errors of an exponential distribution's fourth moment: its eighth is 14833.
    {Kind::weibull, 1., 9., 5. * 1.3 * std::sqrt(14833. / n)}};
  for (const auto &[kind, width, kurtosis, error, sign] : distributions)
  {
    SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << ", width " << width);
    const Distribution distribution(kind, width);
    const Moments found = moments(distribution, n);
    EXPECT_NEAR(found.mean, 0., 5. * width / root);
    EXPECT_NEAR(found.variance, width * width, 5. * std::sqrt(found.fourth - std::pow(found.variance, 2)) / root);
    EXPECT_GE(found.smallest, distribution.smallest());
    EXPECT_LE(found.largest, distribution.largest());
    EXPECT_GT(found.smallest, 0.);
    EXPECT_EQ(distribution.width(), width);
    if (kurtosis > 0.)
    {
      EXPECT_NEAR(found.fourth / (found.variance * found.variance), kurtosis, error);
    }
    EXPECT_GE(found.third * sign, 0.);
    if (kind == Kind::uniform) // fills its range
    {
      EXPECT_NEAR(found.largest, 1. + width * std::sqrt(3.), 20. / n);
      EXPECT_NEAR(found.smallest, 1. - width * std::sqrt(3.), 20. / n);
    }
  }
}

TEST(Distribution, RejectsWidthsOutOfRange)
{
  for (const Kind kind : {Kind::uniform, Kind::normal, Kind::weibull})
  {
    const double widest = Distribution::widest(kind);
    for (const double width : {0., -0.1, 1.01 * widest, std::nan(""), infinity})
      EXPECT_THROW(Distribution(kind, width), std::invalid_argument) << width;
    EXPECT_NO_THROW(Distribution(kind, 0.99 * widest));
    EXPECT_GT(Distribution(kind, 0.99 * widest).factor(3), 0.);
  }
  EXPECT_THROW(Distribution(Kind::uniform, Distribution::widest(Kind::uniform)), std::invalid_argument);
  EXPECT_NO_THROW(Distribution(Kind::weibull, 1.));
  EXPECT_EQ(Distribution(Kind::none, 0.3).factor(5), 1.);
  // Sheets stay the same: SplitMix64 and the cosine of Box and Muller, by a script of its own.
  EXPECT_NEAR(Distribution(Kind::normal, 0.2).factor(3), 1.10215869724156, 1e-14);
  EXPECT_EQ(Distribution().width(), 0.);
}

Material disordered(std::uint64_t seed = 1)
{
  Material material = sheets::rubber();
  material.disorder = {{Kind::uniform, 0.1}, {Kind::normal, 0.2}, seed};
  return material;
}

// theory.md, eq. (L.37): the factors of a bond depend on the seed, the property and the bond; not on other shells, the
// orientation or periods.
TEST(BondFactors, BelongToTheirBond)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = disordered();
  const BondFactors stiffness = bond_factors(sheet, material, BondProperty::stiffness);
  const BondFactors strength = bond_factors(sheet, material, BondProperty::strength);
  Material nearest = material;
  nearest.next_nearest.reset();
  const BondFactors of_nearest = bond_factors(sheet, nearest, BondProperty::stiffness);
  const BondFactors reseeded = bond_factors(sheet, disordered(2), BondProperty::stiffness);
  double n = 0., with_strength = 0., with_next = 0., with_above = 0., with_kind = 0., with_seed = 0.;
  const auto x = [](const BondFactors &factors, std::size_t place, std::size_t kind)
  { return factors.of(place, kind) - 1.; };
  for (std::size_t row = 0; row + 1 < sheet.rows(); ++row)
    for (std::size_t column = 0; column + 2 < sheet.columns(); ++column)
      for (std::size_t kind = 0; kind < 2 * n_kinds_per_shell; ++kind)
      {
        const std::size_t place = sheet.index(row, column);
        if (kind < n_kinds_per_shell)
        {
          EXPECT_EQ(of_nearest.of(place, kind), stiffness.of(place, kind));
        }
        n += 1.;
        with_strength += x(stiffness, place, kind) * x(strength, place, kind) / (0.2 * 0.1);
        with_next += x(stiffness, place, kind) * x(stiffness, place + 1, kind) / (0.2 * 0.2);
        with_above += x(stiffness, place, kind) * x(stiffness, place + sheet.stride(), kind) / (0.2 * 0.2);
        with_kind +=
          x(stiffness, place, kind) * x(stiffness, place, (kind + 1) % (2 * n_kinds_per_shell)) / (0.2 * 0.2);
        with_seed += x(stiffness, place, kind) * x(reseeded, place, kind) / (0.2 * 0.2);
      }
  // Correlations of independent numbers: five standard errors.
  for (const double sum : {with_strength, with_next, with_above, with_kind, with_seed})
    EXPECT_LT(std::abs(sum) / n, 5. / std::sqrt(n));
  EXPECT_TRUE(of_nearest.kinds[n_kinds_per_shell].empty());
}

TEST(Disorder, RefusesStatesOfOtherMaterials)
{
  const TriangularLattice sheet = sheets::square(12);
  const Eigen::Matrix2d F = sheets::stretched(1.2, 1.2);
  const auto start = [&](const Material &of_state, const Material &material) {
    return Simulation(RowPartition(sheet), material, homogeneous_state(sheet, of_state, F, Edges::held), {1e-8, 0});
  };
  EXPECT_NO_THROW(start(disordered(), disordered()));
  EXPECT_THROW(start(sheets::rubber(), disordered()), std::invalid_argument);
  EXPECT_THROW(start(disordered(), sheets::rubber()), std::invalid_argument);
}

} // namespace disorder_test
