#include "verification/input/field_expression.h"

#include <cctype>
#include <cmath>
#include <regex>

#include "support/errors.h"
#include "support/full_precision.h"
#include "verification/input/case_text.h"

namespace latcon::input
{
namespace
{

// Returns whether an expression assigns, as in `x = 1`, which muparser evaluates to 1. Comparisons are allowed.
bool assigns(const std::string &expression)
{
  const std::string others = std::regex_replace(expression, std::regex("=="), "##");
  return std::regex_search(others, std::regex("(^|[^<>!])="));
}

// Returns the expression without blanks between a function and its arguments, which muparser does not accept.
std::string joined_calls(const std::string &text)
{
  std::string joined;
  for (const char c : text)
  {
    if (c == '(')
      while (joined.size() > 1 && joined.back() == ' ' && joined.find_last_not_of(' ') != std::string::npos &&
             std::isalnum(static_cast<unsigned char>(joined[joined.find_last_not_of(' ')])) != 0)
        joined.pop_back();
    joined += c;
  }
  return joined;
}

} // namespace

FieldExpression::FieldExpression(const std::string &text) : text_(text)
{
  try
  {
    parser_.DefineConst("pi", std::acos(-1.));
    parser_.DefineVar("x", &x_);
    parser_.DefineVar("y", &y_);
    parser_.DefineFun("if", +[](double condition, double yes, double no) { return std::lround(condition) != 0 ? yes : no; });
    parser_.DefineOprt("|", +[](double a, double b) { return std::lround(a) != 0 || std::lround(b) != 0 ? 1. : 0.; }, 1);
    parser_.DefineOprt("&", +[](double a, double b) { return std::lround(a) != 0 && std::lround(b) != 0 ? 1. : 0.; }, 2);
    parser_.DefineFun("int", +[](double a) { return std::round(a); });
    parser_.DefineFun("ceil", +[](double a) { return std::ceil(a); });
    parser_.DefineFun("floor", +[](double a) { return std::floor(a); });
    parser_.DefineFun("cot", +[](double a) { return 1. / std::tan(a); });
    parser_.DefineFun("csc", +[](double a) { return 1. / std::sin(a); });
    parser_.DefineFun("sec", +[](double a) { return 1. / std::cos(a); });
    parser_.DefineFun("log", +[](double a) { return std::log(a); });
    parser_.DefineFun("pow", +[](double a, double b) { return std::pow(a, b); });
    parser_.DefineFun("erf", +[](double a) { return std::erf(a); });
    parser_.DefineFun("erfc", +[](double a) { return std::erfc(a); });
    parser_.SetExpr(joined_calls(text));
    (void)parser_.Eval();
  }
  catch (const mu::ParserError &error)
  {
    throw support::InputError(error.GetMsg());
  }
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
  std::string context = "not an expression in x, y and pi: ";
  // muparser takes the last entry of a list, but the user may have meant a decimal comma or both components.
  int open = 0;
  for (const char c : expression)
  {
    open += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && open == 0)
      return context + "a list where one number is wanted";
  }
  if (assigns(expression))
    return context + "an assignment; to compare, write ==";
  if (std::regex_search(expression, std::regex("\\brand(_seed)?\\b"))) // a sheet is the same on every rank
    return context + "random numbers, which differ from run to run";
  try
  {
    FieldExpression field(expression);
    context.clear(); // the other messages name the expression
    for (const auto &[x, y] : points)
      (void)field(x, y);
    return "";
  }
  catch (const support::InputError &error)
  {
    return context + error.what();
  }
}

} // namespace latcon::input
