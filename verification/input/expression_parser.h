/// Expressions in cases, read by muParser: bond laws, which can be differentiated, and fields in x and y.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <muParser.h>

#include "support/errors.h"
#include "support/expression.h"

namespace latcon::input
{

/// An expression that cannot be read; what() names the column of the mistake, and of a bond law what is allowed.
class InvalidExpression : public support::InputError
{
public:
  using support::InputError::InputError;
};

/// Reads the expression of a bond law: numbers, names, ( ), + - * / ^ and sqrt, exp, log of
/// one argument: no assignments, comparisons, conditions or lists, and no other functions. `^` is right-associative and
/// binds more strongly than a sign. Numbers are decimal, 4.9e-324 to 1.8e308 in magnitude or 0.
/// @param text     the expression, at most 2000 characters
/// @param variable name of its variable
/// @param values   values by name of what else it may use
/// @param used     if given, the names in the expression are added to it
/// @throws InvalidExpression for an expression that is not understood
[[nodiscard]] support::Expression parse_expression(const std::string &text, const std::string &variable,
                                                   const std::map<std::string, double> &values,
                                                   std::set<std::string> *used = nullptr);

/// Returns whether a word can be the name of a value: a letter, then letters, digits and underscores, and no function.
[[nodiscard]] bool is_value_name(const std::string &word);

/// Value of an expression in x, y [m] and pi: a load or a displacement of the continuum. Functions that muParser does
/// not have are those of dealii::FunctionParser.
class FieldExpression
{
public:
  /// @throws InvalidExpression for an expression that is not understood
  explicit FieldExpression(const std::string &text);
  FieldExpression(const FieldExpression &) = delete; // the parser refers to x_ and y_
  FieldExpression &operator=(const FieldExpression &) = delete;

  /// @throws support::InputError for a value that is no finite number
  double operator()(double x, double y);

private:
  std::string text_;
  double x_ = 0., y_ = 0.;
  mu::Parser parser_;
};

/// Returns why a text cannot be such an expression, or at which of some points X, Y [m] its value is not finite; an
/// empty text if neither.
[[nodiscard]] std::string problem_with_field(const std::string &expression,
                                             const std::vector<std::array<double, 2>> &points);

} // namespace latcon::input
