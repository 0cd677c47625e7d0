#include "verification/input/user_law.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "tests/support/thrown.h"
#include "tests/verification/input/sentences.h"
#include "tests/verification/input/small_case.h"
#include "verification/claims/claim_inputs.h"
#include "verification/input/expression_parser.h"

namespace user_law_test
{

using namespace latcon;

double value(const support::Expression &e, double x)
{
  std::vector<double> values;
  for (const auto &[operation, number, left, right] : e.nodes())
    values.push_back(operation == support::Expression::Operation::variable
                       ? x
                       : support::evaluate(operation, number, values.empty() ? 0. : values[left],
                                           values.empty() ? 0. : values[right]));
  return values[e.result];
}

const std::map<std::string, double> constants{{"mu", 2.}, {"alpha", -3.}};

TEST(ExpressionParser, HasTheUsualGrammar)
{
  for (const sentences::Sentence &own : sentences::of({"value"}))
    EXPECT_EQ(value(input::parse_expression(own.input, "lam", constants), 2.), std::stod(own.message)) << own;
  // exp(lam ln(lam))
  EXPECT_NEAR(value(input::parse_expression("lam^lam", "lam", constants), 2.), 4., 1e-14);
}

TEST(ExpressionParser, ListsTheNamesInAnExpression)
{
  std::set<std::string> used;
  (void)input::parse_expression("1e5*mu + exp(mu)", "lam", constants, &used);
  EXPECT_EQ(used, (std::set<std::string>{"mu"}));
  (void)input::parse_expression("lam", "lam", constants, &used);
  EXPECT_EQ(used, (std::set<std::string>{"lam", "mu"}));
}

TEST(ExpressionParser, NamesTheColumnOfAMistakeAndWhatIsAllowed)
{
  for (const sentences::Sentence &own : sentences::of({"psi"}))
    EXPECT_EQ(message_of<input::InvalidExpression>(
                [&] { (void)input::parse_expression(sentences::unescaped(own.input), "lam", constants); }),
              own.message + "; allowed: numbers, + - * / ^ ( ), sqrt, exp, log, lam, alpha, mu");
  for (const std::string &text : {std::string("  "), std::string(3000, '(')})
    EXPECT_THROW((void)input::parse_expression(text, "lam", constants), input::InvalidExpression);
}

// What a case says about the entries of nearest neighbours, and others; empty for nothing.
std::string problems(const std::vector<std::string> &settings, std::vector<std::string> all = {},
                     input::Case *read = nullptr)
{
  for (const std::string &setting : settings)
    all.push_back("Nearest neighbours/" + setting);
  input::Case input;
  const small_case::Lines found = small_case::problems(all, read != nullptr ? *read : input);
  return found.empty() ? "" : support::InputError(found).what();
}

const std::string psi = "psi=mu/2*(lam^2 + 2/lam - 3)";

TEST(UserLaw, IsThatOfTheExpressionAndItsParameters)
{
  input::Case input;
  ASSERT_EQ(problems({"law=expression", psi, "parameters= mu = 0.1 MPa"}, {}, &input), "");
  const lattice::BondLaw law = input.material().nearest.law;
  EXPECT_NEAR(lattice::force(law, 2.), 1e5 * (2. - 0.25), 1e-9);
  // Entries of the section are values as well, unless a parameter has their name.
  ASSERT_EQ(problems({"law=expression", "psi=a*(lam-1)^2 + b*(lam-1)^2", "a=3", "parameters=b=0.5"}, {}, &input), "");
  EXPECT_EQ(lattice::stiffness(input.material().nearest.law, 2.), 7.);
  // The law need not have values where no bond gets.
  const std::string locks = "psi=-lam-(k-1)*log(k-lam)";
  EXPECT_EQ(problems({"law=expression", locks, "parameters=k=1.9"}), "");
  EXPECT_NE(problems({"law=expression", locks, "parameters=k=1.7"}), "");
}

// At the end of the step in which it breaks, a bond is longer than its breaking stretch, by h r of eq. (L.26). Without
// dashpots r^2 = 8 e / m / d^2 = 24 s psi / (rho d^2), with the area factor s = 2/3.
TEST(UserLaw, NeedsValuesForWhatABondGainsWithinAStep)
{
  const auto found = [](const std::string &limit, const std::string &step)
  {
    return problems({"law=expression", "psi=-lam-(k-1)*log(k-lam)", "parameters=k=" + limit},
                    {"Next-nearest neighbours/present=false", "Fracture/breaking stretch=2", "Contact/present=false",
                     "Time/step=" + step});
  };
  // psi(2) - psi(1) = 1.1 ln 11 - 1 Pa: 166.6 per second
  EXPECT_EQ(found("2.1", "0.3 ms"), "");
  EXPECT_NE(found("2.1", "1 ms").find("a bond can be longer by 0.1666"), std::string::npos) << found("2.1", "1 ms");
  EXPECT_EQ(found("2.3", "1 ms"), "");
}

// A law that claims accept must be one with which the case runs: both have the same largest stretch.
TEST(UserLaw, HasTheSameLargestStretchInClaims)
{
  input::Case input;
  ASSERT_EQ(problems({"law=expression", psi, "parameters=mu = 0.1 MPa"}, {}, &input), "");
  input.density = 944.;
  input.breaking_stretch = 3.;
  input.toughening = input::Case::Toughening::behind_tip;
  input.toughening_factor = 2.;
  EXPECT_EQ(claims::claim_inputs(input).longest_stretch(), 6.);
  const std::string text = claims::claim_inputs_text(input);
  input.toughening_factor = 2.5;
  EXPECT_NE(claims::claim_inputs_text(input), text);
}

TEST(UserLaw, RefusesExpressionsWithTooManyOperations)
{
  std::string tower = "psi=lam";
  for (int i = 0; i < 390; ++i)
    tower += "^-lam";
  const std::string found = problems({"law=expression", tower});
  EXPECT_NE(found.find("it is too long: more than 1000 operations"), std::string::npos) << found;
}

TEST(UserLaw, SaysWhichEntryIsWrong)
{
  for (const sentences::Sentence &own : sentences::of({"law"}))
  {
    const std::string found = problems(sentences::entries(own.input));
    EXPECT_NE(found.find(own.message), std::string::npos) << own << "\n" << found;
    EXPECT_NE(found.find("; with Nearest neighbours/law"), std::string::npos) << found;
  }
}

} // namespace user_law_test
