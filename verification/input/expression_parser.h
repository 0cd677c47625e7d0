/// Expressions in cases, as functions of one variable that can be differentiated.
#pragma once

#include <map>
#include <set>
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

/// Reads an expression by muParser, of whose grammar it admits numbers, names, ( ), + - * / ^ and sqrt, exp, log of
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

} // namespace latcon::input
