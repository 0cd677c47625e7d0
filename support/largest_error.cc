#include "support/largest_error.h"

#include <cmath>

namespace latcon::support
{
namespace
{

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double finite_or_not_a_number(double value)
{
  return std::isfinite(value) ? value : not_a_number;
}

Extremes extremes_of(std::initializer_list<double> values)
{
  Extremes extremes;
  for (const double value : values)
    extremes.add(value);
  return extremes;
}

} // namespace

double relative_error(double value, double reference)
{
  return finite_or_not_a_number(std::abs(value / reference - 1.));
}

double one_sided(double excess)
{
  if (!std::isfinite(excess))
    return not_a_number;
  return excess > 0. ? excess : 0.;
}

double largest_of(std::initializer_list<double> values)
{
  return extremes_of(values).largest();
}

double smallest_of(std::initializer_list<double> values)
{
  return extremes_of(values).smallest();
}

void LargestError::add(double error, double value, double reference)
{
  const bool has_failed = !is_empty_ && std::isnan(error_);
  const bool is_smaller = !is_empty_ && std::isfinite(error) && error <= error_;
  if (has_failed || is_smaller)
    return;
  is_empty_ = false;
  error_ = finite_or_not_a_number(error);
  value_ = value;
  reference_ = reference;
}

void LargestError::add_difference(double value, double reference)
{
  add(std::abs(value - reference), value, reference);
}

void Extremes::add(double value)
{
  const double finite = finite_or_not_a_number(value);
  if (is_empty_)
    smallest_ = largest_ = finite;
  // Comparisons with NaN are false, so extremes that are NaN remain NaN.
  else if (std::isnan(finite))
    smallest_ = largest_ = not_a_number;
  else if (finite < smallest_)
    smallest_ = finite;
  else if (finite > largest_)
    largest_ = finite;
  is_empty_ = false;
}

} // namespace latcon::support
