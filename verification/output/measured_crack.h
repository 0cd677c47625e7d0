/// Measurements of a crack, as read from the output directory of its run.
#pragma once

#include <optional>
#include <string>

#include "verification/output/crack_quantities.h"

namespace latcon::output
{

/// Pattern and quantities of a crack.
struct MeasuredCrack
{
  std::string pattern; ///< "straight", "oscillating", "branching", "arrested" or "undecided"
  std::string problem; ///< rows that make it unfit as a measurement; empty if there are none
  Values values;
};

/// Reads crack.json and, if it exists, near_tip.json of a run.
/// @param spacing d [m]
/// @return none if the run has not ended, or its files are damaged
[[nodiscard]] std::optional<MeasuredCrack> read_measured_crack(const std::string &folder, double spacing);

} // namespace latcon::output
