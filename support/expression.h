#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace latcon::support
{

/// A function of one variable x, as the list of the operations that compute it. The list holds data alone: its users
/// evaluate and differentiate it, each in its own way.
class Expression
{
public:
  enum class Operation
  {
    variable,    ///< x
    constant,    ///< value
    add,         ///< left + right
    subtract,    ///< left - right
    multiply,    ///< left right
    divide,      ///< left / right
    power,       ///< left^value
    square_root, ///< sqrt(left)
    exponential, ///< exp(left)
    logarithm    ///< ln(left)
  };

  /// One operation. Operands are indices of earlier nodes; unused ones are 0.
  struct Node
  {
    Operation operation;
    double value; ///< of a constant, or the exponent of a power; otherwise 0
    std::size_t left, right;
  };

  /// Each returns the index of its node. Equal operations have one node, and operations on constants are constants.
  /// @throws std::length_error beyond max_nodes
  std::size_t variable();
  std::size_t constant(double value);
  std::size_t apply(Operation operation, std::size_t left, std::size_t right = 0);
  /// left^right; exp(right ln(left)) unless `right` is a constant.
  std::size_t power(std::size_t left, std::size_t right);

  const std::vector<Node> &nodes() const { return nodes_; }
  bool is_constant(std::size_t node) const { return nodes_[node].operation == Operation::constant; }
  bool is_constant(std::size_t node, double value) const { return is_constant(node) && nodes_[node].value == value; }

  std::size_t result = 0; ///< node of the value of the function

  /// Most nodes of one list; evaluation needs memory for as many numbers.
  static constexpr std::size_t max_nodes = 1000;

private:
  std::size_t add(const Node &node);

  std::vector<Node> nodes_;
};

/// An operation on two numbers, of which unary ones ignore the second; `value` is the exponent of a power.
/// @tparam Number double, or a type with its functions such as the jets of Boost
template <class Number>
Number evaluate(Expression::Operation operation, double value, const Number &left, const Number &right)
{
  using std::exp, std::log, std::pow, std::sqrt;
  switch (operation)
  {
  case Expression::Operation::variable:
    return left;
  case Expression::Operation::constant:
    return value;
  case Expression::Operation::add:
    return left + right;
  case Expression::Operation::subtract:
    return left - right;
  case Expression::Operation::multiply:
    return left * right;
  case Expression::Operation::divide:
    return left / right;
  case Expression::Operation::power:
    return pow(left, value);
  case Expression::Operation::square_root:
    return sqrt(left);
  case Expression::Operation::exponential:
    return exp(left);
  case Expression::Operation::logarithm:
    return log(left);
  }
  throw std::logic_error("an operation without a rule");
}

} // namespace latcon::support
