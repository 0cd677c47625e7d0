/// Errors and extremes from which a number that is not finite cannot be lost.
///
/// `std::max(0., NaN)` is 0 and `std::max(x, NaN)` is x, so an error that could not be computed would pass as a small
/// one. Here it stays: rows of claims take their errors and extremes from this file alone.
#pragma once

#include <initializer_list>
#include <limits>

namespace latcon::support
{

/// |value / reference - 1| [-]; not-a-number if that is not finite.
[[nodiscard]] double relative_error(double value, double reference);

/// Error of a one-sided bound: `excess` where it is positive, else 0; not-a-number if `excess` is not finite.
[[nodiscard]] double one_sided(double excess);

/// Largest of one or more numbers; not-a-number if any is not finite.
[[nodiscard]] double largest_of(std::initializer_list<double> values);

/// Smallest of one or more numbers; not-a-number if any is not finite.
[[nodiscard]] double smallest_of(std::initializer_list<double> values);

/// Largest of a sequence of errors, with the value and the reference between which it was found. The first error that
/// is not finite makes it not-a-number, whatever follows; so it is while there is none.
class LargestError
{
public:
  /// Adds an error that belongs to a value beside a reference, or to neither.
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

/// Smallest and largest of a sequence of numbers. The first that is not finite makes both not-a-number, whatever
/// follows; so they are while there is none.
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
