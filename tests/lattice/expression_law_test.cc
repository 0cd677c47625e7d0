#include "lattice/bonds/expression_law.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lattice/bonds/bond_law.h"
#include "lattice/bonds/law_check.h"

namespace expression_law_test
{

using namespace latcon;

using lattice::ExpressionLaw;
using support::Expression;
using Operation = Expression::Operation;

constexpr double longest = 3.;

// Operations in the notation of formulas.
struct Term
{
  Expression *in;
  std::size_t node;
};
Term operator+(Term a, Term b)
{
  return {a.in, a.in->apply(Operation::add, a.node, b.node)};
}
Term operator-(Term a, Term b)
{
  return {a.in, a.in->apply(Operation::subtract, a.node, b.node)};
}
Term operator*(Term a, Term b)
{
  return {a.in, a.in->apply(Operation::multiply, a.node, b.node)};
}
Term operator/(Term a, Term b)
{
  return {a.in, a.in->apply(Operation::divide, a.node, b.node)};
}
Term operator*(double a, Term b)
{
  return Term{b.in, b.in->constant(a)} * b;
}
Term operator/(double a, Term b)
{
  return Term{b.in, b.in->constant(a)} / b;
}
Term operator-(Term a, double b)
{
  return a - Term{a.in, a.in->constant(b)};
}
Term power(Term a, double exponent)
{
  return {a.in, a.in->power(a.node, a.in->constant(exponent))};
}
Term of(Operation function, Term a)
{
  return {a.in, a.in->apply(function, a.node)};
}

Expression expression(const std::function<Term(Term)> &psi)
{
  Expression e;
  e.result = psi({&e, e.variable()}).node;
  return e;
}

Expression mooney_rivlin(double a, double b)
{
  return expression([=](Term l) { return a * (0.5 * power(l, 2.) + 1. / l) + b * (l + 0.5 * power(l, -2.)); });
}

struct Subject
{
  std::string name;
  Expression psi;
  std::function<double(double)> force, stiffness; // by hand
};

const std::vector<Subject> &subjects()
{
  static const std::vector<Subject> all{
    {"sqrt", expression([](Term l) { return l - 2. * of(Operation::square_root, l); }),
     [](double l) { return 1. - 1. / std::sqrt(l); }, [](double l) { return 0.5 * std::pow(l, -1.5); }},
    {"log", expression([](Term l) { return l - of(Operation::logarithm, l); }), [](double l) { return 1. - 1. / l; },
     [](double l) { return 1. / (l * l); }},
    {"exp", expression([](Term l) { return of(Operation::exponential, l) - std::exp(1.) * l; }),
     [](double l) { return std::exp(l) - std::exp(1.); }, [](double l) { return std::exp(l); }},
    {"real power", expression([](Term l) { return power(l, 1.3) - 1.3 * l; }),
     [](double l) { return 1.3 * (std::pow(l, 0.3) - 1.); }, [](double l) { return 0.39 * std::pow(l, -0.7); }},
    {"square of nothing", expression([](Term l) { return power(l - 1., 2.); }), [](double l) { return 2. * (l - 1.); },
     [](double) { return 2.; }},
    {"quotient", expression([](Term l) { return power(l - 1., 2.) / l; }), [](double l) { return 1. - 1. / (l * l); },
     [](double l) { return 2. / (l * l * l); }}};
  return all;
}

// A handful of roundings of terms of size 1 each.
constexpr double rounding = 1e-14;

TEST(ExpressionLaw, HasTheDerivativesFoundByHand)
{
  for (const Subject &subject : subjects())
  {
    const ExpressionLaw law(subject.psi, longest);
    EXPECT_EQ(law.energy(1.), 0.) << subject.name;
    for (const double l : {0.4, 1., 1.7, 3.})
    {
      EXPECT_NEAR(law.force(l), subject.force(l), rounding * (1. + subject.stiffness(l))) << subject.name << ' ' << l;
      EXPECT_NEAR(law.stiffness(l), subject.stiffness(l), rounding * (1. + subject.stiffness(l)))
        << subject.name << ' ' << l;
    }
  }
}

TEST(ExpressionLaw, IsTheBuiltInLaw)
{
  const lattice::MooneyRivlinBond built_in{1e5, 1.5e5};
  const ExpressionLaw law(mooney_rivlin(1e5, 1.5e5), longest);
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

TEST(ExpressionLaw, HasTheSameBitsForAnyNumberOfBonds)
{
  for (const Subject &subject : subjects())
  {
    const ExpressionLaw law(subject.psi, longest);
    std::array<double, 8> stretches{0.31, 0.7, 0.99, 1., 1.2, 1.9, 2.7, 3.}, forces{};
    for (const std::size_t n : {1, 2, 3, 4, 8})
    {
      law.forces(n, stretches.data(), forces.data());
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_EQ(forces[i], law.force(stretches[i])) << subject.name << ' ' << n << ' ' << i;
    }
  }
}

TEST(ExpressionLaw, LeavesAbsentBondsWithoutForce)
{
  const lattice::CustomBond bond(std::make_shared<ExpressionLaw>(subjects()[1].psi, longest));
  std::array<double, 4> stretches{0., 1.5, 0., 2.};
  bond.forces(4, stretches.data());
  EXPECT_EQ(stretches, (std::array<double, 4>{0., bond.force(1.5), 0., bond.force(2.)}));
}

// Stiffest at the end, in the middle, and nowhere finite.
TEST(ExpressionLaw, BoundsTheStiffness)
{
  const ExpressionLaw fung(subjects()[2].psi, longest);
  EXPECT_NEAR(fung.largest_stiffness(0.5), std::exp(3.), 1e-13 * std::exp(3.));
  EXPECT_NEAR(fung.largest_stiffness(4.), std::exp(4.), 1e-13 * std::exp(4.)); // beyond the last bond
  // psi'' = 12 (l - 2)^2 + 6
  const ExpressionLaw valley(expression([](Term l) { return power(l - 2., 4.) + 4. * l + 3. * power(l - 1., 2.); }),
                             longest);
  EXPECT_NEAR(valley.largest_stiffness(1.9), 18., 1e-12); // at 3
  EXPECT_NEAR(valley.largest_stiffness(0.5), 33., 1e-12); // at 0.5
  const ExpressionLaw gent(
    expression([](Term l) { return -1. * of(Operation::logarithm, -1. * (power(l, 2.) + 2. / l - 33.)); }), longest);
  EXPECT_EQ(gent.largest_stiffness(0.01), std::numeric_limits<double>::infinity());
}

std::string problem(const Expression &psi, double longest_stretch = longest)
{
  try
  {
    const ExpressionLaw law(psi, longest_stretch);
  }
  catch (const lattice::InvalidBondLaw &error)
  {
    return error.what();
  }
  return "";
}

TEST(ExpressionLaw, RefusesLawsThatNoBondCanHave)
{
  const auto has = [](const std::string &text, const std::string &part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  has(problem(expression([](Term l) { return power(l - 1., 2.) + l; })), "psi'(1) is 1 Pa");
  has(problem(expression([](Term l) { return -1. * power(l - 1., 2.); })), "psi''(1) is -2 Pa");
  has(problem(expression([](Term l) { return power(l - 1., 4.); })), "psi''(1) is 0 Pa");
  // No value beyond 2.5, where some bonds get.
  const Expression locks = expression([](Term l) { return -1. * l - 1.5 * of(Operation::logarithm, -1. * (l - 2.5)); });
  has(problem(locks), "nan at stretch 2.5");
  EXPECT_EQ(problem(locks, 2.4), "");
}

using Functions = std::vector<std::function<double(double)>>;

TEST(LawCheck, ComparesEachDerivativeWithDifferences)
{
  const Functions right{[](double l) { return std::exp(20. * (l - 1.)) - 20. * l; },
                        [](double l) { return 20. * std::exp(20. * (l - 1.)) - 20.; },
                        [](double l) { return 400. * std::exp(20. * (l - 1.)); },
                        [](double l) { return 8000. * std::exp(20. * (l - 1.)); }};
  EXPECT_NO_THROW(lattice::check_law(right, 0.3, 3.));
  for (const std::size_t wrong : {1, 2, 3})
  {
    Functions functions = right;
    // Off by a thousandth, and right at rest.
    functions[wrong] = [of = right[wrong]](double l) { return of(l) * (1. + 1e-3 * (l - 1.) * (l - 1.)); };
    try
    {
      lattice::check_law(functions, 0.3, 3.);
      ADD_FAILURE() << wrong;
    }
    catch (const lattice::InvalidBondLaw &error)
    {
      EXPECT_NE(std::string(error.what()).find("psi" + std::string(wrong, '\'') + " is"), std::string::npos)
        << error.what();
    }
  }
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
      EXPECT_THROW(lattice::check_law(with(value, from, to), 0.3, 3.), lattice::InvalidBondLaw) << value << ' ' << from;
    EXPECT_NO_THROW(lattice::check_law(with(value, 2.5e-4, 1e-3), 0.3, 3.)) << value;
    // Beyond the last stretch a law needs no value.
    EXPECT_NO_THROW(lattice::check_law(with(value, 1e-12, 1e-3), 0.3, checked)) << value;
  }
}

} // namespace expression_law_test
