#include "verification/input/user_law.h"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "verification/claims/claim_inputs.h"
#include "verification/input/case.h"
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
  for (const auto &[text, at_two] : std::vector<std::pair<std::string, double>>{{"lam", 2.},
                                                                                {"mu/2*(lam^2 + 2/lam - 3)", 2.},
                                                                                {"-lam^2", -4.},
                                                                                {"2^3^2", 512.},
                                                                                {"(-lam)^2", 4.},
                                                                                {"lam^-2", 0.25},
                                                                                {"lam^alpha", 0.125},
                                                                                {"mu*-lam", -4.},
                                                                                {"6/3/2", 1.},
                                                                                {"5-2-1", 2.},
                                                                                {"1e-3*lam + .5", 0.502},
                                                                                {"sqrt(8*lam) - exp(0)", 3.},
                                                                                {"log(lam*0.5)", 0.},
                                                                                {" ( lam ) ", 2.},
                                                                                {"log (lam*0.5)", 0.}})
    EXPECT_EQ(value(input::parse_expression(text, "lam", constants), 2.), at_two) << text;
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
  for (const auto &[text, part] : std::vector<std::pair<std::string, std::string>>{
         {"1 + lan", "unknown 'lan' at column 5; nearest: lam"},
         {"lam,2", "unknown ',' at column 4"},
         {"lam$", "unknown '$' at column 4"},
         {"lam?1:2", "unknown '?' at column 4"},
         {"lam = 2", "unknown '=' at column 5"},
         {"lam \xc2\xb2", "at column 5"},
         {"sqrt(lam", "')' is missing at the end"},
         {"lam)", "parenthesis at column 4"},
         {"sqrt()", "wrong number of arguments of a function at column 6"},
         {"exp lam", "'(' is missing after 'exp' at column 1"},
         {"0x10*lam", "'x10' at column 2"},
         {"2lam", "'lam' is not expected at column 2"},
         {"sin(lam)", "unknown 'sin' at column 1"},
         {"lam +", "ends too early"},
         {"", "an expression is required"},
         {"  ", "an expression is required"},
         {"1e-400*lam", "the number 1e-400 at column 1 is out of range"},
         {"lam + 1e400", "the number 1e400 at column 7 is out of range"}})
    try
    {
      (void)input::parse_expression(text, "lam", constants);
      ADD_FAILURE() << text;
    }
    catch (const input::InvalidExpression &error)
    {
      const std::string what = error.what();
      EXPECT_NE(what.find(part), std::string::npos) << what;
      EXPECT_NE(what.find("; allowed: numbers, + - * / ^ ( ), sqrt, exp, log, lam, alpha, mu"), std::string::npos)
        << what;
    }
  EXPECT_THROW((void)input::parse_expression(std::string(3000, '('), "lam", constants), input::InvalidExpression);
}

// What a case says about the entries of nearest neighbours, and others; empty for nothing.
std::string problems(const std::vector<std::string> &settings, const std::vector<std::string> &others = {},
                     input::Case *read = nullptr)
{
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  std::vector<std::string> all{"Sheet/spacing=1 mm",   "Sheet/length=4 cm",    "Sheet/height=2 cm",
                               "Material/density=944", "Loading/strain x=0.5", "Loading/strain y=0.5"};
  for (const std::string &setting : settings)
    all.push_back("Nearest neighbours/" + setting);
  all.insert(all.end(), others.begin(), others.end());
  parameters.read_overrides(all);
  input.check(parameters);
  try
  {
    parameters.finish();
  }
  catch (const support::InputError &error)
  {
    return error.what();
  }
  if (read != nullptr)
    *read = input;
  return "";
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

// A short text can have many derivatives.
TEST(UserLaw, RefusesExpressionsWithTooManyOperations)
{
  std::string product = "psi=lam", tower = "psi=lam";
  for (int i = 101; i <= 270; ++i)
    product += "*(lam+" + std::to_string(i) + ")";
  for (int i = 0; i < 390; ++i)
    tower += "^-lam";
  for (const auto &[text, part] : {std::pair(product, "its derivatives are too long: more than 1000 operations"),
                                   std::pair(tower, "it is too long: more than 1000 operations")})
  {
    ASSERT_LT(text.size(), 2000u);
    const std::string found = problems({"law=expression", text});
    EXPECT_NE(found.find(part), std::string::npos) << found;
  }
}

TEST(UserLaw, SaysWhichEntryIsWrong)
{
  const std::string key = "Nearest neighbours/";
  for (const auto &[settings, part] : std::vector<std::pair<std::vector<std::string>, std::string>>{
         {{"law=expression"}, key + "psi = : an expression is required"},
         {{"law=expression", psi}, key + psi.substr(0, 3) + " = " + psi.substr(4) + ": unknown 'mu' at column 1"},
         {{"law=expression", psi, "parameters=mu"}, key + "parameters = mu: 'mu': expected NAME = NUMBER"},
         {{"law=expression", psi, "parameters=mu = 1 m"}, "with one of stress"},
         {{"law=expression", psi, "parameters=mu = x"}, "'mu = x': expected a number"},
         {{"law=expression", psi, "parameters=mu = 1, mu = 2"}, "'mu = 2': set twice"},
         {{"law=expression", psi, "parameters=mu = 1, lam = 2"}, "'lam = 2': a name is"},
         {{"law=expression", psi, "parameters=mu = 1, exp = 2"}, "'exp = 2': a name is"},
         {{"law=expression", psi, "parameters=mu = 1, alpha = 2"}, "psi does not use 'alpha'; it uses: lam, mu"},
         {{"law=expression", psi, "parameters=mu = -1"}, "psi''(1) is -3 Pa; a bond at rest needs a stiffness > 0"},
         {{"law=expression", "psi=lam^2"}, "psi'(1) is 2 Pa; a bond at rest has no force"},
         {{"law=library"}, key + "library = : the path of a shared library is required"},
         {{"law=library", "library=none.so"}, key + "library = none.so: cannot read the library"},
         {{"law=library", "library=/dev/zero"}, key + "library = /dev/zero: cannot read the library: it is not a file"},
         {{"law=library", "library=/"}, key + "library = /: cannot read the library: it is not a file"}})
  {
    const std::string found = problems(settings);
    EXPECT_NE(found.find(part), std::string::npos) << part << "\n" << found;
    EXPECT_NE(found.find("; with Nearest neighbours/law"), std::string::npos) << found;
  }
}

} // namespace user_law_test
