#pragma once

#include <string>

#include "verification/analysis/crack_measurement.h"
#include "verification/input/case.h"
#include "verification/output/results.h"

namespace latcon::commands
{

/// What a crack ends with on the terminal, at most a dozen lines of 120 columns: its pattern and why, what was measured
/// with uncertainties and, if the case has any, beside the reference, and the checks that fail.
[[nodiscard]] std::string crack_summary(const input::Case &input, const analysis::CrackMeasurement &crack,
                                        const output::Results &results);

} // namespace latcon::commands
