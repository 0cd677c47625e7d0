#include "support/expression.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace latcon::support
{
namespace
{

bool is_binary(Expression::Operation operation)
{
  return operation == Expression::Operation::add || operation == Expression::Operation::subtract ||
         operation == Expression::Operation::multiply || operation == Expression::Operation::divide;
}

} // namespace

std::size_t Expression::add(const Node &node)
{
  const auto same = std::find_if(nodes_.begin(), nodes_.end(),
                                 [&](const Node &other)
                                 {
                                   return other.operation == node.operation && other.left == node.left &&
                                          other.right == node.right &&
                                          std::memcmp(&other.value, &node.value, sizeof(double)) == 0; // NaN, -0
                                 });
  if (same != nodes_.end())
    return static_cast<std::size_t>(same - nodes_.begin());
  if (nodes_.size() >= max_nodes)
    throw std::length_error("more than " + std::to_string(max_nodes) + " operations");
  nodes_.push_back(node);
  return nodes_.size() - 1;
}

std::size_t Expression::variable()
{
  return add({Operation::variable, 0., 0, 0});
}

std::size_t Expression::constant(double value)
{
  return add({Operation::constant, value, 0, 0});
}

std::size_t Expression::apply(Operation operation, std::size_t left, std::size_t right)
{
  if (is_constant(left) && (!is_binary(operation) || is_constant(right)))
    return constant(evaluate(operation, 0., nodes_[left].value, nodes_[right].value));
  return add({operation, 0., left, is_binary(operation) ? right : 0});
}

std::size_t Expression::power(std::size_t left, std::size_t right)
{
  if (!is_constant(right))
    return apply(Operation::exponential, apply(Operation::multiply, right, apply(Operation::logarithm, left)));
  const double exponent = nodes_[right].value;
  if (is_constant(left))
    return constant(std::pow(nodes_[left].value, exponent));
  return add({Operation::power, exponent, left, 0});
}

} // namespace latcon::support
