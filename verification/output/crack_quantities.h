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

/// Name of the only quantity that is a word: "straight", "oscillating", "branching" or "arrested".
inline constexpr const char *pattern_quantity = "pattern";
/// Word for a crack whose pattern could not be determined.
inline constexpr const char *undecided_pattern = "undecided";

/// Returns the patterns that a row can require.
[[nodiscard]] const std::vector<std::string> &pattern_words();

/// Returns the SI unit of a quantity. @throws std::logic_error if there is no such quantity
[[nodiscard]] std::string unit_of(const std::string &quantity);

/// Finite values by quantity; quantities that were not measured are absent.
using Values = std::map<std::string, double>;

/// Adds the quantities derived from the values of a run and its lattice spacing d [m].
void add_derived(Values &values, double spacing);

} // namespace latcon::output
