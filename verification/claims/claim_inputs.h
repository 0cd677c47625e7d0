/// Checks of claims on the subject of a case, and the entries of it that they may read.
#pragma once

#include <string>
#include <vector>

#include "verification/bridge/laws.h"
#include "verification/claims/claim.h"
#include "verification/input/case.h"

namespace latcon::claims
{

/// Values in `input` of the entries that all claims read, and of the `further` ones: a line `Section/Name=value` for
/// each, in SI and full precision, by key. Two cases with the same text are the same to the claims.
/// @throws std::logic_error if a further entry does not exist
[[nodiscard]] std::string claim_inputs_text(const input::Case &input, const std::vector<std::string> &further = {});

/// A case with the entries of claim_inputs_text() as in `input`, every other entry as declared, and a sheet of a fixed
/// number of spacings. Claims are given nothing else, so that no verdict can depend on an entry that is not listed.
[[nodiscard]] input::Case claim_inputs(const input::Case &input, const std::vector<std::string> &further = {});

/// Everything that verdicts depend on, in one text, and its hash.
struct VerdictKey
{
  explicit VerdictKey(std::string inputs);

  std::string text; ///< a line for each input
  std::string hash; ///< SHA-256 of the text, 64 hexadecimal digits
};

/// Returns the key of a check: hash of the program, claims and their size, laws that are judged, number of MPI ranks,
/// and the entries that the claims read; of claims that are about the program alone the first two. The shared libraries
/// of the check are kept with its verdicts.
/// @throws std::runtime_error if the program cannot read itself
[[nodiscard]] VerdictKey verdict_key(const input::Case &input, const std::vector<Claim> &claims,
                                     const bridge::Laws &laws, bool quick, unsigned int n_ranks);

/// Largest stretch [-] at which claims evaluate bond laws, except those of a loaded or
/// breaking sheet.
inline constexpr double largest_stretch = 3.5;

/// Reports user-defined laws without values at stretches at which claims evaluate them. To be called before
/// Parameters::finish() by commands that check claims.
void check_user_laws(const input::Case &input, input::Parameters &parameters);

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
