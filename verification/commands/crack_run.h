#pragma once

#include <vector>

#include "verification/analysis/crack_measurement.h"
#include "verification/claims/claim.h"
#include "verification/commands/command.h"
#include "verification/output/histories.h"

namespace latcon::commands
{

// What the runs of a crack have in common, whichever side breaks.

/// Returns time, position and speed of a crack for its progress line.
std::string crack_progress(double time, const output::TipHistory &tip);

/// Returns the rows `fracture` of a crack: its measured quantities beside the published ones, and its energies.
/// @param imbalance output::LedgerCheck::imbalance() [-] @param allowed with which it holds
output::Results measured_results(const input::Case &input, const analysis::CrackMeasurement &crack, double imbalance,
                                 const output::Tolerance &allowed);

/// Checks claims on the case's own material and pre-stretch, as require_verified(). A crack that they refuse leaves its
/// page all the same.
output::Results passed_or_reported(const input::Case &input, const std::vector<claims::Claim> &claims,
                                   const bridge::Laws &laws, const input::Options &options, Run &run);

/// Ends the run of a crack: writes its results, prints its summary, draws its page. Collective. @return the exit code
/// of the command
support::ExitCode end_crack(const input::Case &input, const input::Options &options, Run &run,
                            const output::Results &results, const analysis::CrackMeasurement &crack);

} // namespace latcon::commands
