#pragma once

#include <nlohmann/json_fwd.hpp>

#include "verification/analysis/crack_measurement.h"

namespace latcon::output
{

/// What crack.json says of every crack, on either side: pattern, reason, measured quantities with
/// uncertainties, and the thresholds that decided.
[[nodiscard]] nlohmann::ordered_json crack_json(const analysis::CrackMeasurement &measurement);

} // namespace latcon::output
