/// Expressions in cases, as functions of one variable that can be differentiated.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "support/expression.h"

namespace latcon::input
{

/// An expression that cannot be read; what() names the column of the mistake and what is allowed.
class InvalidExpression : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Reads an expression by muParser, whose grammar it has: numbers, names, ( ), + - * / ^ and sqrt, exp, log. `^` is
/// right-associative and binds more strongly than a sign.
/// @param text     the expression, at most 2000 characters
/// @param variable name of its variable
/// @param values   values by name of what else it may use
/// @throws InvalidExpression for an expression that is not understood
[[nodiscard]] support::Expression parse_expression(const std::string &text, const std::string &variable,
                                                   const std::map<std::string, double> &values);

/// Returns whether a word can be the name of a value: a letter, then letters, digits and underscores, and no function.
[[nodiscard]] bool is_value_name(const std::string &word);

} // namespace latcon::input
