/// Numbers with readable units.
#pragma once

#include <optional>
#include <string>

namespace latcon::output
{

/// Formats a number with a readable unit: lengths in cm, areas in mm^2, times in ms.
/// @param deviation standard deviation in the same unit, or none
[[nodiscard]] std::string quantity_text(double value, std::optional<double> deviation, const std::string &unit);

} // namespace latcon::output
