/// Quantities that a study records of a run: names and units.
#pragma once

#include <string>
#include <vector>

namespace latcon::output
{

/// Quantity of crack.json or near_tip.json, or computed from those and the case.
struct CrackQuantity
{
  std::string name;
  std::string unit; ///< SI, "1" for a pure number; angles in "degrees"
};

/// Returns all quantities, in the order of study.csv. Fields of quantities that a run does not have are empty.
[[nodiscard]] const std::vector<CrackQuantity> &crack_quantities();

} // namespace latcon::output
