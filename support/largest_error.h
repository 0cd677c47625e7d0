/// Errors and extremes that propagate values that are not finite.
///
/// `std::max(0., NaN)` is 0 and `std::max(x, NaN)` is x, so with std::max an error that could not be computed would
/// count as small. The rows of claims must take their errors and extremes from this file, which propagates NaN.
#pragma once

#include <initializer_list>
#include <limits>

namespace latcon::support
{

/// Returns |value / reference - 1| [-]; NaN if that is not finite.
[[nodiscard]] double relative_error(double value, double reference);

/// Returns the error of a one-sided bound: `excess` if positive, otherwise 0; NaN if `excess` is not finite.
[[nodiscard]] double one_sided(double excess);

/// Returns the largest of one or more numbers; NaN if any is not finite.
[[nodiscard]] double largest_of(std::initializer_list<double> values);

/// Returns the smallest of one or more numbers; NaN if any is not finite.
[[nodiscard]] double smallest_of(std::initializer_list<double> values);

/// Largest of a sequence of errors, with its value and reference. NaN for an empty sequence, and from the first error
/// on that is not finite.
class LargestError
{
public:
  /// Adds an error, optionally with its value and reference.
  void add(double error, double value = std::numeric_limits<double>::quiet_NaN(),
           double reference = std::numeric_limits<double>::quiet_NaN());

  /// Adds relative_error(value, reference).
  void add_relative(double value, double reference) { add(relative_error(value, reference), value, reference); }

  /// Adds |value - reference|.
  void add_difference(double value, double reference);

  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double reference() const { return reference_; }

private:
  bool is_empty_ = true;
  double error_ = std::numeric_limits<double>::quiet_NaN(), value_ = error_, reference_ = error_;
};

/// Smallest and largest of a sequence of numbers. NaN for an empty sequence, and from the first number on that is not
/// finite.
class Extremes
{
public:
  /// Adds a number.
  void add(double value);

  [[nodiscard]] double smallest() const { return smallest_; }
  [[nodiscard]] double largest() const { return largest_; }

private:
  bool is_empty_ = true;
  double smallest_ = std::numeric_limits<double>::quiet_NaN(), largest_ = smallest_;
};

} // namespace latcon::support
