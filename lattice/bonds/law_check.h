#pragma once

#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include "lattice/bonds/laws.h"

namespace latcon::lattice
{

/// A bond law that a lattice cannot have; what() says which of its values is wrong, at which stretch, or why its
/// library cannot be used.
class InvalidBondLaw : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// Shortest stretch [-] at which a law of a case must have a value.
inline constexpr double smallest_checked_stretch = 0.3;

/// Checks the functions of a law: psi, psi', psi'' [Pa] and possibly further derivatives by the stretch, in this order.
/// From smallest_checked_stretch to `longest` [-] all are finite, psi and psi' without poles, and each agrees with
/// differences of the one before it; psi'(1) = 0 to 1e-12 psi''(1), and psi''(1) > 0.
/// @throws InvalidBondLaw
void check_law(const std::vector<std::function<double(double)>> &functions, double longest);

/// A law without a closed form of the bound on psi'' and psi' / lam: it is the largest value on a grid of stretches.
class CheckedLaw : public CustomBondLaw
{
public:
  /// Infinity if the law has no value there.
  double largest_stiffness(double smallest_stretch) const noexcept override;

protected:
  /// Checks this law as check_law does and bounds its stiffness, before largest_stiffness().
  /// @param longest largest stretch of an unbroken bond [-], > 1
  void check(double longest);

private:
  std::map<double, double> largest_; // [Pa], from a stretch [-] to the last
};

} // namespace latcon::lattice
