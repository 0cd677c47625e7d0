/// The claims that the program knows.
#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

struct ClaimInput;

/// All claims, in the order in which they are checked and shown. A claim NAME is an item here, and a folder NAME that
/// defines NAME_descriptor() in descriptor.cc and check_NAME() in check.cc.
// clang-format off
#define LATCON_CLAIMS(item) \
  item(energy) \
  item(wave_speeds) \
  item(viscoelastic_waves) \
  item(relaxation) \
  item(intrinsic_length) \
  item(disorder) \
  item(prestretch) \
  item(steady_crack) \
  item(running_crack) \
  item(damage)
// clang-format on

// The descriptor belongs to the program, the function that checks the claim to its module with the finite elements.
#define LATCON_DECLARE_CLAIM(name)                                                                                     \
  [[nodiscard]] Claim name##_descriptor();                                                                             \
  [[nodiscard]] ClaimOutcome check_##name(const ClaimInput &input);
LATCON_CLAIMS(LATCON_DECLARE_CLAIM)
#undef LATCON_DECLARE_CLAIM

} // namespace latcon::claims
