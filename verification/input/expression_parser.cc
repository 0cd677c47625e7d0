#include "verification/input/expression_parser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <system_error>
#include <vector>

#include <muParser.h>

#include "verification/input/case_text.h"

namespace latcon::input
{
namespace
{

using Operation = support::Expression::Operation;

constexpr std::array functions{"sqrt", "exp", "log"};
constexpr std::size_t longest_text = 2000;

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
double record_plus(double argument)
{
  return argument;
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
  parser.DefineInfixOprt("+", record_plus, mu::prINFIX, false);
  parser.DefineFun(functions[0], record_function<Operation::square_root>, false);
  parser.DefineFun(functions[1], record_function<Operation::exponential>, false);
  parser.DefineFun(functions[2], record_function<Operation::logarithm>, false);
  parser.AddValIdent(record_number);
}

std::string problem_with(const mu::Parser::exception_type &error, const std::string &text,
                         const std::vector<std::string> &names)
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
    if (!word.empty() && std::find(functions.begin(), functions.end(), word) != functions.end())
      return "a '(' is missing after '" + word + "'" + at;
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
    return "a function takes one argument" + at;
  default:
    return "'" + printable(error.GetToken()) + "' is not expected" + at;
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
  std::vector<std::string> names{variable};
  for (const auto &[name, value] : values)
    names.push_back(name);
  std::string allowed = "; allowed: numbers, + - * / ^ ( ), ";
  for (const char *function : functions)
  {
    allowed += std::string(function) + ", ";
    names.emplace_back(function);
  }
  allowed += variable;
  for (const auto &[name, value] : values)
    allowed += ", " + name;
  if (text.find_first_not_of(' ') == std::string::npos)
    throw InvalidExpression("an expression is required" + allowed);
  if (text.size() > longest_text)
    throw InvalidExpression("it has more than " + std::to_string(longest_text) + " characters");
  // muParser has further operators that cannot be switched off; a comma often is a decimal one.
  for (std::size_t i = 0; i < text.size(); ++i)
    if (std::isalnum(static_cast<unsigned char>(text[i])) == 0 &&
        std::string("_.+-*/^() ").find(text[i]) == std::string::npos)
      throw InvalidExpression("unknown '" + printable(text.substr(i, 1)) + "' at column " + std::to_string(i + 1) +
                              allowed);

  support::Expression expression;
  recorded = &expression;
  try
  {
    mu::Parser parser;
    define_grammar(parser);
    auto node = static_cast<double>(expression.variable());
    parser.DefineVar(variable, &node);
    std::map<std::string, double> nodes; // muParser refers to them
    for (const auto &[name, value] : values)
      parser.DefineVar(name, &(nodes[name] = static_cast<double>(expression.constant(value))));
    parser.SetExpr(text);
    expression.result = static_cast<std::size_t>(parser.Eval());
    if (used != nullptr)
      for (const auto &[name, place] : parser.GetUsedVar())
        used->insert(name);
  }
  catch (const mu::Parser::exception_type &error)
  {
    throw InvalidExpression(problem_with(error, text, names) + allowed);
  }
  catch (const InvalidExpression &error)
  {
    throw InvalidExpression(error.what() + allowed);
  }
  catch (const std::length_error &error)
  {
    throw InvalidExpression(std::string("it is too long: ") + error.what());
  }
  return expression;
}

} // namespace latcon::input
