#include "verification/input/expression_parser.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <regex>
#include <system_error>

#include "support/full_precision.h"
#include "verification/input/case_text.h"

namespace latcon::input
{
namespace
{

using Operation = support::Expression::Operation;

constexpr std::array functions{"sqrt", "exp", "log"};
constexpr std::size_t longest_text = 2000;

// Functions of dealii::FunctionParser that muParser lacks, and the natural logarithm.
struct FunctionOfField
{
  const char *name;
  double (*value)(double);
};
constexpr FunctionOfField functions_of_fields[] = {{"int", std::round},
                                                   {"ceil", std::ceil},
                                                   {"floor", std::floor},
                                                   {"log", std::log},
                                                   {"erf", std::erf},
                                                   {"erfc", std::erfc},
                                                   {"cot", [](double a) { return 1. / std::tan(a); }},
                                                   {"csc", [](double a) { return 1. / std::sin(a); }},
                                                   {"sec", [](double a) { return 1. / std::cos(a); }}};

// muParser computes with doubles. Here each of them is the index of a node, and the operators and functions given to
// muParser record their nodes in this list instead of computing, while parse_expression() runs. muParser passes no
// context to operators.
thread_local support::Expression *recorded = nullptr;

double record(Operation operation, double left, double right = 0.)
{
  return static_cast<double>(
    recorded->apply(operation, static_cast<std::size_t>(left), static_cast<std::size_t>(right)));
}
template <Operation operation>
double record_binary(double left, double right)
{
  return record(operation, left, right);
}
template <Operation operation>
double record_function(double argument)
{
  return record(operation, argument);
}
double record_power(double left, double right)
{
  return static_cast<double>(recorded->power(static_cast<std::size_t>(left), static_cast<std::size_t>(right)));
}
double record_minus(double argument)
{
  return record(Operation::multiply, static_cast<double>(recorded->constant(-1.)), argument);
}

// Reads a number at the start of the text, whatever the locale.
int record_number(const char *text, int *position, double *value)
{
  if (std::isdigit(static_cast<unsigned char>(*text)) == 0 && *text != '.')
    return 0;
  double number = 0.;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
  if (error == std::errc::result_out_of_range) // muParser would read it, as the index of a node
    throw InvalidExpression("the number " + std::string(text, end) + " at column " + std::to_string(*position + 1) +
                            " is out of range");
  if (error != std::errc())
    return 0;
  *position += static_cast<int>(end - text);
  *value = static_cast<double>(recorded->constant(number));
  return 1;
}

void define_grammar(mu::Parser &parser)
{
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  parser.EnableBuiltInOprt(false);
  parser.DefineOprt("+", record_binary<Operation::add>, mu::prADD_SUB, mu::oaLEFT);
  parser.DefineOprt("-", record_binary<Operation::subtract>, mu::prADD_SUB, mu::oaLEFT);
  parser.DefineOprt("*", record_binary<Operation::multiply>, mu::prMUL_DIV, mu::oaLEFT);
  parser.DefineOprt("/", record_binary<Operation::divide>, mu::prMUL_DIV, mu::oaLEFT);
  parser.DefineOprt("^", record_power, mu::prPOW, mu::oaRIGHT);
  parser.DefineInfixOprt("-", record_minus, mu::prINFIX, false);
  parser.DefineInfixOprt(
    "+", +[](double argument) { return argument; }, mu::prINFIX, false);
  parser.DefineFun(functions[0], record_function<Operation::square_root>, false);
  parser.DefineFun(functions[1], record_function<Operation::exponential>, false);
  parser.DefineFun(functions[2], record_function<Operation::logarithm>, false);
  parser.AddValIdent(record_number);
}

std::string problem_with(const mu::Parser::exception_type &error, const std::string &text, const mu::Parser &parser)
{
  const auto position = static_cast<std::size_t>(std::max(0, error.GetPos()));
  const std::string at =
    position < text.size() ? " at column " + std::to_string(position + 1) : std::string(" at the end");
  switch (error.GetCode())
  {
  case mu::ecUNASSIGNABLE_TOKEN:
  {
    std::size_t end = position;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
      ++end;
    const std::string word = text.substr(position, std::max<std::size_t>(end - position, 1));
    if (parser.GetFunDef().count(word) != 0)
      return "a '(' is missing after '" + word + "'" + at;
    std::vector<std::string> names;
    for (const auto &[name, place] : parser.GetVar())
      names.push_back(name);
    for (const auto &[name, function] : parser.GetFunDef())
      names.push_back(name);
    return "unknown '" + printable(word) + "'" + at + nearest_hint(word, names);
  }
  case mu::ecMISSING_PARENS:
    return "a ')' is missing" + at;
  case mu::ecUNEXPECTED_PARENS:
    return "unexpected parenthesis" + at;
  case mu::ecUNEXPECTED_EOF:
    return "it ends too early";
  case mu::ecTOO_MANY_PARAMS:
  case mu::ecTOO_FEW_PARAMS:
    return "wrong number of arguments of a function" + at;
  default:
    return error.GetToken().empty() ? error.GetMsg() : "'" + printable(error.GetToken()) + "' is not expected" + at;
  }
}

// Returns the value of an expression, or its node. Functions may be followed by blanks, which muParser does not accept.
double evaluated(mu::Parser &parser, const std::string &text)
{
  if (text.find_first_not_of(' ') == std::string::npos)
    throw InvalidExpression("an expression is required");
  if (text.size() > longest_text)
    throw InvalidExpression("it has more than " + std::to_string(longest_text) + " characters");
  const std::string joined = std::regex_replace(text, std::regex("([A-Za-z]\\w*)( +)\\("), "$2$1(");
  try
  {
    parser.SetExpr(joined);
    const double value = parser.Eval();
    if (parser.GetNumResults() != 1) // the user may have meant a decimal comma or both components
      throw InvalidExpression("a list where one number is wanted");
    return value;
  }
  catch (const mu::Parser::exception_type &error)
  {
    throw InvalidExpression(problem_with(error, joined, parser));
  }
}

} // namespace

bool is_value_name(const std::string &word)
{
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])) != 0 &&
         std::all_of(word.begin(), word.end(),
                     [](const unsigned char c) { return std::isalnum(c) != 0 || c == '_'; }) &&
         std::find(functions.begin(), functions.end(), word) == functions.end();
}

support::Expression parse_expression(const std::string &text, const std::string &variable,
                                     const std::map<std::string, double> &values, std::set<std::string> *used)
{
  support::Expression expression;
  // cppcheck-suppress danglingLifetime ; read while the text is parsed
  recorded = &expression;
  try
  {
    // muParser has further operators that cannot be switched off.
    for (std::size_t i = 0; i < text.size(); ++i)
      if (std::isalnum(static_cast<unsigned char>(text[i])) == 0 &&
          std::string("_.+-*/^() ").find(text[i]) == std::string::npos)
        throw InvalidExpression("unknown '" + printable(text.substr(i, 1)) + "' at column " + std::to_string(i + 1));
    mu::Parser parser;
    define_grammar(parser);
    auto node = static_cast<double>(expression.variable());
    parser.DefineVar(variable, &node);
    std::map<std::string, double> nodes; // muParser refers to them
    for (const auto &[name, value] : values)
      parser.DefineVar(name, &(nodes[name] = static_cast<double>(expression.constant(value))));
    expression.result = static_cast<std::size_t>(evaluated(parser, text));
    if (used != nullptr)
      for (const auto &[name, place] : parser.GetUsedVar())
        used->insert(name);
  }
  catch (const InvalidExpression &error)
  {
    std::string allowed = "; allowed: numbers, + - * / ^ ( ), ";
    for (const char *function : functions)
      allowed += std::string(function) + ", ";
    allowed += variable;
    for (const auto &[name, value] : values)
      allowed += ", " + name;
    throw InvalidExpression(error.what() + allowed);
  }
  catch (const std::length_error &error)
  {
    throw InvalidExpression(std::string("it is too long: ") + error.what());
  }
  return expression;
}

FieldExpression::FieldExpression(const std::string &text) : text_(text)
{
  parser_.DefineConst("pi", std::acos(-1.));
  parser_.DefineVar("x", &x_);
  parser_.DefineVar("y", &y_);
  for (const auto &[name, function] : functions_of_fields)
    parser_.DefineFun(name, function);
  parser_.DefineFun("pow", static_cast<double (*)(double, double)>(std::pow));
  parser_.DefineFun(
    "if", +[](double is_true, double yes, double no) { return std::lround(is_true) != 0 ? yes : no; });
  parser_.DefineOprt(
    "|", +[](double a, double b) { return std::lround(a) != 0 || std::lround(b) != 0 ? 1. : 0.; }, mu::prLOR);
  parser_.DefineOprt(
    "&", +[](double a, double b) { return std::lround(a) != 0 && std::lround(b) != 0 ? 1. : 0.; }, mu::prLAND);
  // muParser would evaluate `x = 1` to 1.
  if (std::regex_search(std::regex_replace(text, std::regex("=="), "##"), std::regex("(^|[^<>!])=")))
    throw InvalidExpression("an assignment; to compare, write ==");
  (void)evaluated(parser_, text);
}

double FieldExpression::operator()(const double x, const double y)
{
  x_ = x;
  y_ = y;
  const double value = parser_.Eval();
  if (!std::isfinite(value))
    throw support::InputError("the expression '" + printable(text_) + "' is no finite number at x = " +
                              support::full_precision(x) + " m, y = " + support::full_precision(y) + " m");
  return value;
}

std::string problem_with_field(const std::string &expression, const std::vector<std::array<double, 2>> &points)
{
  try
  {
    FieldExpression field(expression);
    for (const auto &[x, y] : points)
      (void)field(x, y);
    return "";
  }
  catch (const InvalidExpression &error)
  {
    return std::string("not an expression in x, y and pi: ") + error.what();
  }
  catch (const support::InputError &error)
  {
    return error.what();
  }
}

} // namespace latcon::input
