/// Rows by which a complete check of the claims is recognised.
#pragma once

#include <string>

#include "verification/output/results.h"

namespace latcon::claims
{

/// Compares verdicts that hold, of the verification before fracture, with the rows that its claims decide for every
/// lattice: the claim, the quantity behind the name of the shells, and that a number was compared with a tolerance.
/// Rows of other claims, or without the shells that `shells` names ("NN", "NN+NNN"), are none of theirs.
/// @return the first row that is missing or foreign, in words; empty: none
[[nodiscard]] std::string row_problem(const output::Results &results, const std::string &shells);

} // namespace latcon::claims
