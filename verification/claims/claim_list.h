/// The functions that check the claims of claim_table.inc, and their input.
#pragma once

#include <string>

#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"
#include "verification/input/case.h"

namespace latcon::claims
{

/// Input of the check of a claim.
struct ClaimInput
{
  const bridge::Subject &subject; ///< a lattice, and the laws that should agree with it
  const input::Case &entries;     ///< has the values of Claim::entries; every other entry has its default
  bool quick;                     ///< small version, a few seconds
  std::string frames;             ///< folder for frames of sheets in motion, on one rank; empty: none are written
};

#define LATCON_CLAIM(name, ...) [[nodiscard]] ClaimOutcome check_##name(const ClaimInput &input);
#include "verification/claims/claim_table.inc"
#undef LATCON_CLAIM

} // namespace latcon::claims
