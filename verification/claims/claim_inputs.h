/// What of a case the claims may read, and nothing else: the one list of these entries.
#pragma once

#include <string>

#include "verification/input/case.h"

namespace latcon::claims
{

/// The entries that claims may read, as they stand in `input`: a line `Section/Name=value` for each, in SI and full
/// precision, in the order of declaration. Two cases with the same text are the same to the claims.
[[nodiscard]] std::string claim_inputs_text(const input::Case &input);

/// A case with the entries of claim_inputs_text() as in `input`, every other one as declared, and a sheet of a fixed
/// number of spacings. Subjects are made of it, so that no verdict can hang on an entry that is not listed: a claim
/// that wants another entry finds its default until the entry is added to the list.
[[nodiscard]] input::Case claim_inputs(const input::Case &input);

} // namespace latcon::claims
