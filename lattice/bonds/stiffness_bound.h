#pragma once

#include <vector>

#include "lattice/bonds/custom_bond.h"

namespace latcon::lattice
{

/// Bound on psi'' and psi' / lam of a law without a closed form of it: their largest value on a grid of stretches.
class StiffnessBound
{
public:
  /// @param law outlives the calls that it is passed to
  /// @param longest largest stretch of an unbroken bond [-], > 1
  StiffnessBound(const CustomBondLaw &law, double longest);

  /// Returns the bound [Pa] for stretches from `smallest` [-] on; infinity if the law has no value there.
  double from(const CustomBondLaw &law, double smallest) const;

private:
  std::vector<double> stretches_; // [-], increasing
  std::vector<double> largest_;   // [Pa], from each stretch to the last
};

} // namespace latcon::lattice
