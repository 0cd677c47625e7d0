/// What a study can say of a run: the names, units and places of its numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace latcon::study
{

/// Number that a study records of each run.
struct StudyQuantity
{
  /// Where the number is read.
  enum class Source
  {
    crack,    ///< crack.json, under its own name
    near_tip, ///< near_tip.json, under its own name
    derived   ///< computed from others and from the case
  };

  std::string name;
  std::string unit; ///< SI, "1" for a pure number; angles in "degrees"
  Source source;
};

/// All numbers, in the order of study.csv. Those that a run does not have are left empty there.
[[nodiscard]] const std::vector<StudyQuantity> &quantities();

/// The one quantity that is a word: "straight", "oscillating", "branching" or "arrested".
inline constexpr const char *pattern_quantity = "pattern";
/// The word for a crack whose record does not settle its pattern.
inline constexpr const char *undecided_pattern = "undecided";

/// The words for a pattern that a row can state.
[[nodiscard]] const std::vector<std::string> &pattern_words();

/// The SI unit of a quantity. @throws std::logic_error for a name that is none
[[nodiscard]] std::string unit_of(const std::string &quantity);

/// Numbers by quantity; what was not measured is not in it. All finite.
using Values = std::map<std::string, double>;

/// Adds what follows from a run's numbers and its lattice spacing d [m].
void add_derived(Values &values, double spacing);

} // namespace latcon::study
