// Laws of bonds typed as expressions, as the lattice evaluates them.
#include "lattice/bonds/expression_law.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lattice/bonds/formulas.h"
#include "lattice/bonds/law_check.h"
#include "tests/support/thrown.h"
#include "verification/input/expression_parser.h"

namespace expression_law_test
{

using namespace latcon;

using lattice::ExpressionLaw;

constexpr double longest = 3.;

ExpressionLaw law_of(const std::string &psi, double longest_stretch = longest)
{
  return {input::parse_expression(psi, "l", {{"e", std::exp(1.)}}), longest_stretch};
}

const struct
{
  const char *psi;
  std::function<double(double)> force, stiffness; // by hand
} laws[] = {
  {"l - 2*sqrt(l)", [](double l) { return 1. - 1. / std::sqrt(l); }, [](double l) { return 0.5 * std::pow(l, -1.5); }},
  {"l - log(l)", [](double l) { return 1. - 1. / l; }, [](double l) { return 1. / (l * l); }},
  {"exp(l) - e*l", [](double l) { return std::exp(l) - std::exp(1.); }, [](double l) { return std::exp(l); }},
  {"l^1.3 - 1.3*l", [](double l) { return 1.3 * (std::pow(l, 0.3) - 1.); },
   [](double l) { return 0.39 * std::pow(l, -0.7); }},
  {"(l-1)^2", [](double l) { return 2. * (l - 1.); }, [](double) { return 2.; }},
  {"(l-1)^2/l", [](double l) { return 1. - 1. / (l * l); }, [](double l) { return 2. / (l * l * l); }},
  {"sqrt(3+l^2) - l/2", [](double l) { return l / std::sqrt(3. + l * l) - 0.5; },
   [](double l) { return 3. * std::pow(3. + l * l, -1.5); }}};

// A handful of roundings of terms of size 1 each.
constexpr double rounding = 1e-14;

TEST(ExpressionLaw, HasTheDerivativesFoundByHandForAnyNumberOfBonds)
{
  for (const auto &[psi, force, stiffness] : laws)
  {
    const ExpressionLaw law = law_of(psi);
    EXPECT_EQ(law.energy(1.), 0.) << psi;
    std::array<double, 8> stretches{0.31, 0.7, 0.99, 1., 1.2, 1.9, 2.7, 3.}, forces{};
    for (const double l : stretches)
    {
      EXPECT_NEAR(law.force(l), force(l), rounding * (1. + stiffness(l))) << psi << ' ' << l;
      EXPECT_NEAR(law.stiffness(l), stiffness(l), rounding * (1. + stiffness(l))) << psi << ' ' << l;
    }
    for (int shift = 0; shift < 2000; ++shift)
      for (const std::size_t n : {1, 2, 3, 4, 8})
      {
        stretches[n - 1] += 1e-4;
        law.forces(n, stretches.data(), forces.data());
        for (std::size_t i = 0; i < n; ++i)
          ASSERT_EQ(forces[i], law.force(stretches[i])) << psi << ' ' << n << ' ' << i;
      }
  }
}

TEST(ExpressionLaw, IsTheBuiltInLaw)
{
  const lattice::MooneyRivlinBond built_in{1e5, 1.5e5};
  const ExpressionLaw law = law_of("1e5*(l^2/2 + 1/l) + 1.5e5*(l + l^-2/2)");
  for (const double l : {0.3, 0.8, 1., 1.9, 3.})
  {
    const double stiffness = built_in.stiffness(l);
    EXPECT_NEAR(law.energy(l), built_in.energy(l), rounding * stiffness) << l;
    EXPECT_NEAR(law.force(l), lattice::formulas::force(built_in, l, 1. / l), rounding * stiffness) << l;
    EXPECT_NEAR(law.stiffness(l), stiffness, rounding * stiffness) << l;
    if (l <= 1.) // in long bonds psi' / lam is larger than psi''
    {
      EXPECT_NEAR(law.largest_stiffness(l), built_in.largest_stiffness(l), rounding * stiffness) << l;
    }
  }
}

// Stiffest at the end, in the middle, and nowhere finite.
TEST(ExpressionLaw, BoundsTheStiffness)
{
  const ExpressionLaw fung = law_of("exp(l) - e*l");
  EXPECT_NEAR(fung.largest_stiffness(0.5), std::exp(3.), 1e-13 * std::exp(3.));
  EXPECT_NEAR(fung.largest_stiffness(4.), std::exp(4.), 1e-13 * std::exp(4.)); // beyond the last bond
  const ExpressionLaw valley = law_of("(l-2)^4 + 4*l + 3*(l-1)^2");            // psi'' = 12 (l - 2)^2 + 6
  EXPECT_NEAR(valley.largest_stiffness(1.9), 18., 1e-12);                      // at 3
  EXPECT_NEAR(valley.largest_stiffness(0.5), 33., 1e-12);                      // at 0.5
  const ExpressionLaw gent = law_of("-log(33 - l^2 - 2/l)");
  EXPECT_EQ(gent.largest_stiffness(0.01), std::numeric_limits<double>::infinity());
}

std::string problem(const std::string &psi, double longest_stretch = longest)
{
  return message_of<lattice::InvalidBondLaw>([&] { (void)law_of(psi, longest_stretch); });
}

TEST(ExpressionLaw, RefusesLawsThatNoBondCanHave)
{
  const std::string locks = "-l - 1.5*log(2.5 - l)"; // where some bonds get there is no value
  for (const auto &[psi, part] : {std::pair(std::string("(l-1)^2 + l"), "psi'(1) is 1 Pa"),
                                  {"-(l-1)^2", "psi''(1) is -2 Pa"},
                                  {"(l-1)^4", "psi''(1) is 0 Pa"},
                                  {locks, "nan at stretch 2.5"},
                                  {"(l-1)^2/(2-l)", "psi is not continuous between stretches 1.9"},
                                  {"(l-1)^2/(2-l)^2", "psi' is not continuous between stretches 1.9"}})
    EXPECT_NE(problem(psi).find(part), std::string::npos) << psi << ": " << problem(psi);
  EXPECT_EQ(problem(locks, 2.4), "");
}

using Functions = std::vector<std::function<double(double)>>;

TEST(LawCheck, ComparesEachDerivativeWithDifferences)
{
  const Functions right{[](double l) { return std::exp(20. * (l - 1.)) - 20. * l; },
                        [](double l) { return 20. * std::exp(20. * (l - 1.)) - 20.; },
                        [](double l) { return 400. * std::exp(20. * (l - 1.)); },
                        [](double l) { return 8000. * std::exp(20. * (l - 1.)); }};
  EXPECT_NO_THROW(lattice::check_law(right, 3.));
  for (const std::size_t wrong : {1, 2, 3})
  {
    Functions functions = right;
    // Off by a thousandth, and right at rest.
    functions[wrong] = [of = right[wrong]](double l) { return of(l) * (1. + 1e-3 * (l - 1.) * (l - 1.)); };
    const std::string message = message_of<lattice::InvalidBondLaw>([&] { lattice::check_law(functions, 3.); });
    EXPECT_NE(message.find("psi" + std::string(wrong, '\'') + " is"), std::string::npos) << message;
  }
}

// Laws of a library may have branches: here psi''' jumps down while its slope is 1.
TEST(LawCheck, LetsHigherDerivativesJump)
{
  const auto beyond = [](double l) { return std::max(l - 2.003, 0.); };
  EXPECT_NO_THROW(lattice::check_law(
    {[&](double l) { return std::pow(l - 1., 2) / 2. + std::pow(l - 1., 4) / 24. - 0.4 / 6. * std::pow(beyond(l), 3); },
     [&](double l) { return l - 1. + std::pow(l - 1., 3) / 6. - 0.2 * std::pow(beyond(l), 2); },
     [&](double l) { return 1. + std::pow(l - 1., 2) / 2. - 0.4 * beyond(l); },
     [&](double l) { return l - 1. - (beyond(l) > 0. ? 0.4 : 0.); }, [](double) { return 1.; }},
    3.));
}

// Stretch 0.3 * 1.01^100 = 0.811 of the check has a value, a neighbour has none.
TEST(LawCheck, RefusesDifferencesWithoutValue)
{
  double checked = 0.3;
  for (int i = 0; i < 100; ++i)
    checked *= 1.01;
  const Functions right{[](double l) { return 0.5 * (l - 1.) * (l - 1.); }, [](double l) { return l - 1.; },
                        [](double) { return 1.; }};
  // Differences reach 1e-4 and 2e-4 of the stretch to both sides.
  const auto with = [&](double value, double from, double to)
  {
    Functions functions = right;
    functions[0] = [=, psi = right[0]](double l)
    {
      const double above = l / checked - 1.;
      return above > from && above < to ? value : psi(l);
    };
    return functions;
  };
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
  {
    for (const auto &[from, to] : {std::pair(0.5e-4, 1.5e-4), std::pair(1.5e-4, 2.5e-4), std::pair(0.5e-4, 2.5e-4)})
      EXPECT_THROW(lattice::check_law(with(value, from, to), 3.), lattice::InvalidBondLaw) << value << ' ' << from;
    EXPECT_NO_THROW(lattice::check_law(with(value, 2.5e-4, 1e-3), 3.)) << value;
    // Beyond the last stretch a law needs no value.
    EXPECT_NO_THROW(lattice::check_law(with(value, 1e-12, 1e-3), checked)) << value;
  }
}

} // namespace expression_law_test
