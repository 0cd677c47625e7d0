#pragma once

#include <functional>
#include <memory>

#include <deal.II/base/auto_derivative_function.h>
#include <deal.II/lac/vector.h>

#include "verification/input/continuum_case.h"

namespace latcon::bridge
{

/// Vector field of a case as a function of the finite elements. Gradients are differences of fourth order: their step
/// balances the error of the formula against round-off.
class FieldFunction : public dealii::AutoDerivativeFunction<2>
{
public:
  /// @param extent length of the sheet [m], the scale on which the field varies
  FieldFunction(const input::FieldCase &field, double extent)
    : dealii::AutoDerivativeFunction<2>(1e-3 * extent, 2), field_(field.field())
  {
    set_formula(dealii::AutoDerivativeFunction<2>::FourthOrder);
  }

  /// @throws InputError with the position if the value is not finite
  double value(const dealii::Point<2> &X, unsigned int component) const override
  {
    return field_(component, X[0], X[1]);
  }

  void vector_value(const dealii::Point<2> &X, dealii::Vector<double> &values) const override
  {
    for (unsigned int component = 0; component < 2; ++component)
      values[component] = value(X, component);
  }

private:
  std::function<double(unsigned int, double, double)> field_;
};

} // namespace latcon::bridge
