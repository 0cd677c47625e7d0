/// Quantities that a study records of a run: names, units and sources.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace latcon::output
{

/// Quantity that a study records of each run.
struct CrackQuantity
{
  /// Source of the value.
  enum class Source
  {
    crack,    ///< crack.json, under its own name
    near_tip, ///< near_tip.json, under its own name
    derived   ///< computed from other quantities and the case
  };

  std::string name;
  std::string unit; ///< SI, "1" for a pure number; angles in "degrees"
  Source source;
};

/// Returns all quantities, in the order of study.csv. Fields of quantities that a run does not have are empty.
[[nodiscard]] const std::vector<CrackQuantity> &crack_quantities();

/// Finite values by quantity; quantities that were not measured are absent.
using Values = std::map<std::string, double>;

/// Adds the quantities derived from the values of a run and its lattice spacing d [m].
void add_derived(Values &values, double spacing);

} // namespace latcon::output
