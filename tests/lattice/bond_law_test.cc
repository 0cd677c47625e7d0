#include "lattice/bonds/bond_law.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace bond_law_test
{

using namespace latcon;

using lattice::BondLaw;

const std::vector<BondLaw> laws{lattice::MooneyRivlinBond{1e5, 1.5e5}, lattice::LinearBond{2.35e5}};
constexpr double stretches[] = {0.4, 0.8, 1., 1.7, 3.05};

// Observed order of |f(x + h) - f(x) - h f'(x)| as h is halved twice; 2 if f' is the derivative, 1 if it is not. A law
// whose second derivative vanishes leaves round-off alone, for which 2 is returned.
template <class Function, class Derivative>
double taylor_slope(const Function &f, const Derivative &df, double x)
{
  const auto remainder = [&](double h) { return std::abs(f(x + h) - f(x) - h * df(x)); };
  const double round_off = 1e-15 * (std::abs(f(x)) + std::abs(df(x)));
  if (remainder(1e-3) < 10. * round_off)
    return 2.;
  return std::log2(remainder(1e-3) / remainder(2.5e-4)) / 2.;
}

// theory.md, eq. (L.2).
TEST(BondLaw, ForceIsEnergyGradient)
{
  for (const BondLaw &law : laws)
    for (const double lam : stretches)
      EXPECT_NEAR(taylor_slope([&](double l) { return energy(law, l); }, [&](double l) { return force(law, l); }, lam),
                  2., 0.05)
        << lam;
}

TEST(BondLaw, StiffnessIsForceGradient)
{
  for (const BondLaw &law : laws)
    for (const double lam : stretches)
      EXPECT_NEAR(
        taylor_slope([&](double l) { return force(law, l); }, [&](double l) { return stiffness(law, l); }, lam), 2.,
        0.05)
        << lam;
}

TEST(BondLaw, LargestStiffnessIsThatOfTheShortestBond)
{
  for (const BondLaw &law : laws)
    for (const double lam : stretches)
    {
      EXPECT_EQ(largest_stiffness(law, 0.4), stiffness(law, 0.4));
      EXPECT_LE(stiffness(law, lam), largest_stiffness(law, 0.4));
      EXPECT_LE(force(law, lam) / lam, largest_stiffness(law, 0.4));
    }
}

// The stiffness of a = 1, b = -0.4 has its largest value at no end of the stretches, and its energy no lower bound.
TEST(BondLaw, RefusesConstantsThatBoundNoStiffness)
{
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto &[a, b] : {std::pair(1., -0.4), std::pair(-0.4, 1.), std::pair(0., 0.), std::pair(-1., -1.),
                             std::pair(infinity, 1.), std::pair(nan, 1.), std::pair(1., nan), std::pair(1e308, 1e308)})
    EXPECT_THROW(lattice::MooneyRivlinBond(a, b), std::invalid_argument) << a << ' ' << b;
  for (const auto &[a, b] : {std::pair(1., 0.), std::pair(0., 1.)})
    EXPECT_NO_THROW(lattice::MooneyRivlinBond(a, b));
  for (const double modulus : {0., -1., infinity, nan})
    EXPECT_THROW(lattice::LinearBond{modulus}, std::invalid_argument) << modulus;
}

TEST(BondLaw, RestIsFreeOfEnergyAndForce)
{
  for (const BondLaw &law : laws)
  {
    EXPECT_EQ(energy(law, 1.), 0.);
    EXPECT_EQ(force(law, 1.), 0.);
  }
}

TEST(BondLaw, SaysWhetherShortBondsAreStiffer)
{
  for (const BondLaw &law : laws)
    EXPECT_EQ(stiffens_when_short(law), stiffness(law, 0.1) > stiffness(law, 1.));
}

// By hand at lam = 2: psi = a + 5/8 b, psi' = 7/4 a + 7/8 b, psi'' = 5/4 a + 3/16 b; at rest psi'' = 3 (a + b).
TEST(MooneyRivlinBond, HasHandComputedValues)
{
  const lattice::MooneyRivlinBond law{8., 16.};
  EXPECT_DOUBLE_EQ(law.energy(2.), 8. + 10.);
  EXPECT_DOUBLE_EQ(force(law, 2.), 14. + 14.);
  EXPECT_DOUBLE_EQ(law.stiffness(2.), 10. + 3.);
  EXPECT_DOUBLE_EQ(law.stiffness(1.), 72.);
}

TEST(LinearBond, HasHandComputedValues)
{
  const lattice::LinearBond law{4.};
  EXPECT_DOUBLE_EQ(law.energy(1.5), 0.5);
  EXPECT_DOUBLE_EQ(force(law, 1.5), 2.);
  EXPECT_DOUBLE_EQ(law.stiffness(1.5), 4.);
}

} // namespace bond_law_test
