/// Expressions in x, y and pi: loads and displacements of the continuum.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <muParser.h>

namespace latcon::input
{

/// Value of an expression in x, y [m] and pi. Functions that muparser does not have are those of
/// dealii::FunctionParser.
class FieldExpression
{
public:
  /// @throws support::InputError for an expression that is not understood
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
