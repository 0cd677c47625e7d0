/// Rows by which a complete verification before fracture is recognised.
#pragma once

#include <string>
#include <vector>

#include "verification/claims/claim.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Compares verdicts with the rows that `claims` require: the claim, the quantity behind the name of the shells, and
/// that a number was compared with a tolerance. Rows of other claims, or without the shells that `shells` names ("NN",
/// "NN+NNN"), are foreign.
/// @return a message about the first row that is missing or foreign; empty: none
[[nodiscard]] std::string row_problem(const output::Results &results, const std::string &shells,
                                      const std::vector<Claim> &claims);

} // namespace latcon::claims
