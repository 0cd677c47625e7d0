/// Checks of claims on the subject of a case.
#pragma once

#include <string>
#include <vector>

#include "verification/bridge/laws.h"
#include "verification/claims/claim.h"
#include "verification/input/case.h"

namespace latcon::claims
{

struct ClaimInput;

/// Lattices on which claims are checked.
enum class Shells
{
  own,             ///< the lattice of the case
  own_and_nearest, ///< also the one with nearest-neighbour bonds alone, if the case has further shells
};

/// Checks the claim of this name. Collective. @throws std::out_of_range if there is none
[[nodiscard]] ClaimOutcome check_claim(const std::string &name, const ClaimInput &input);

/// Checks claims on the subject of a case, small versions if `quick`. Collective.
/// @param laws laws that are judged; results for others are reported
/// @param frames folder for frames of sheets in motion, on one rank; empty: none are written
ClaimOutcome run_claims(const input::Case &input, const std::vector<Claim> &claims, bool quick, Shells shells,
                        const bridge::Laws &laws, const std::string &frames = {});

} // namespace latcon::claims
