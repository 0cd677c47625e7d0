#include "lattice/bonds/formulas.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/relaxation.h"
#include "tests/lattice/sheets.h"

namespace bond_law_test
{

using namespace latcon::lattice;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const std::vector<BondLaw> laws{MooneyRivlinBond{1e5, 1.5e5}, LinearBond{2.35e5}};
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
TEST(BondLaw, HasItsDerivativesAndNoEnergyAtRest)
{
  for (const BondLaw &law : laws)
  {
    const auto psi = [&](double l) { return energy(law, l); };
    const auto pull = [&](double l) { return force(law, l); };
    const auto slope = [&](double l) { return stiffness(law, l); };
    for (const double lam : stretches)
    {
      EXPECT_NEAR(taylor_slope(psi, pull, lam), 2., 0.05) << lam;
      EXPECT_NEAR(taylor_slope(pull, slope, lam), 2., 0.05) << lam;
    }
    EXPECT_EQ(psi(1.), 0.);
    EXPECT_EQ(pull(1.), 0.);
    EXPECT_EQ(stiffens_when_short(law), slope(0.1) > slope(1.));
  }
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
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto &[a, b] : {std::pair(1., -0.4), std::pair(-0.4, 1.), std::pair(0., 0.), std::pair(-1., -1.),
                             std::pair(infinity, 1.), std::pair(nan, 1.), std::pair(1., nan), std::pair(1e308, 1e308)})
    EXPECT_THROW(MooneyRivlinBond(a, b), std::invalid_argument) << a << ' ' << b;
  for (const auto &[a, b] : {std::pair(1., 0.), std::pair(0., 1.)})
    EXPECT_NO_THROW(MooneyRivlinBond(a, b));
  for (const double modulus : {0., -1., infinity, nan})
    EXPECT_THROW(LinearBond{modulus}, std::invalid_argument) << modulus;
}

// By hand at lam = 2: psi = a + 5/8 b, psi' = 7/4 a + 7/8 b, psi'' = 5/4 a + 3/16 b; at rest psi'' = 3 (a + b).
TEST(MooneyRivlinBond, HasHandComputedValues)
{
  const MooneyRivlinBond law{8., 16.};
  EXPECT_DOUBLE_EQ(law.energy(2.), 8. + 10.);
  EXPECT_DOUBLE_EQ(force(law, 2.), 14. + 14.);
  EXPECT_DOUBLE_EQ(law.stiffness(2.), 10. + 3.);
  EXPECT_DOUBLE_EQ(law.stiffness(1.), 72.);
}

TEST(LinearBond, HasHandComputedValues)
{
  const LinearBond law{4.};
  EXPECT_DOUBLE_EQ(law.energy(1.5), 0.5);
  EXPECT_DOUBLE_EQ(force(law, 1.5), 2.);
  EXPECT_DOUBLE_EQ(law.stiffness(1.5), 4.);
}

// A linear law with mistakes to choose.
struct Mistaken
{
  double at_rest = 0.;                                      // energy [Pa]
  double pull = 0.;                                         // force at rest [Pa]
  double modulus = 2e5;                                     // [Pa]
  double longest = std::numeric_limits<double>::infinity(); // beyond this stretch there is no value

  double within(double stretch, double value) const { return stretch <= longest ? value : nan; }
  double energy(double stretch) const
  {
    return within(stretch, at_rest + 0.5 * modulus * (stretch - 1.) * (stretch - 1.));
  }
  double force(double stretch) const { return within(stretch, pull + modulus * (stretch - 1.)); }
  double stiffness(double stretch) const { return within(stretch, modulus); }
  double largest_stiffness(double) const { return 4. * modulus; }
};

TEST(CustomBond, HasToBeFreeAndStiffAtRest)
{
  EXPECT_THROW(CustomBond(nullptr), std::invalid_argument);
  EXPECT_NO_THROW(sheets::from_outside(Mistaken{}));
  EXPECT_NO_THROW(sheets::from_outside(Mistaken{1e-8, -1e-8})); // round-off of 2e5 Pa
  for (const Mistaken &law : {Mistaken{1.}, Mistaken{0., -1.}, Mistaken{nan}, Mistaken{0., nan}, Mistaken{0., 0., 0.},
                              Mistaken{0., 0., -1.}, Mistaken{0., 0., nan}})
    EXPECT_THROW(sheets::from_outside(law), std::invalid_argument);
}

// A law without a value gives NaN at the ends of its bond alone; a relaxation stops.
TEST(CustomBond, WithoutAValueIsSeen)
{
  const TriangularLattice sheet = sheets::square(8);
  Material material = sheets::nearest_only(0.);
  material.nearest.law = sheets::from_outside(Mistaken{0., 0., 2e5, 1.5});
  State state = homogeneous_state(sheet, material, sheets::stretched(1.2, 1.2), Edges::held);
  const std::size_t left = sheet.index(3, 3), right = left + 1;
  state.position.x[left] -= 0.2 * sheets::spacing; // now the bonds to its right have stretches of 1.4 and less
  Forces forces(sheet, material);
  forces.evaluate(state, state.velocity);
  EXPECT_TRUE(std::isfinite(forces.on_sites().x[left]));
  state.position.x[left] -= 0.2 * sheets::spacing; // 1.6 along the row, 1.44 upwards
  forces.evaluate(state, state.velocity);
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    EXPECT_EQ(std::isfinite(forces.on_sites().x[place]), place != left && place != right) << place;
    EXPECT_EQ(std::isfinite(forces.on_sites().y[place]), place != left && place != right) << place;
  }
  EXPECT_THROW(relax(state, sheet, material, 1e-6), std::runtime_error);
}

} // namespace bond_law_test
