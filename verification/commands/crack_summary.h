#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/analysis/crack_measurement.h"
#include "verification/input/case.h"
#include "verification/output/results.h"

namespace latcon::commands
{

/// Number of checks that hold and fail, a line for each claim.
[[nodiscard]] std::string claim_lines(const output::Results &results);

/// Seconds of each phase: "claims 8.1 s, fracture 61 s".
[[nodiscard]] std::string times_text(const std::vector<std::pair<std::string, double>> &times);

/// Summary of a crack for the terminal, in lines of 120 columns: its pattern with the criterion, measured quantities
/// with uncertainties and, if the case has any, reference values, a line for each claim, and rows that fail. At most a
/// dozen lines if none fails.
[[nodiscard]] std::string crack_summary(const input::Case &input, const analysis::CrackMeasurement &crack,
                                        const output::Results &results);

} // namespace latcon::commands
