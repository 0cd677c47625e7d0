/// The claims that the program knows.
#pragma once

#include <string>
#include <vector>

#include "verification/claims/claim.h"

namespace latcon::commands
{

/// All claims, in the order in which they are checked and shown.
[[nodiscard]] const std::vector<claims::Claim> &claim_registry();

/// Claims checked by `latcon verify` for these names on the command line; without names the default ones.
/// @param names of the registry, in any order
/// @param material of the lattice
[[nodiscard]] std::vector<claims::Claim> selected_claims(const std::vector<std::string> &names,
                                                         const lattice::Material &material);

/// Claims that must hold before a crack is run. @param material of the sheet that breaks @param on_continuum whether it is
/// the continuum in place of the lattice
[[nodiscard]] std::vector<claims::Claim> claims_before_fracture(const lattice::Material &material,
                                                                bool on_continuum = false);

/// Message about a name that is not in the registry, with the nearest name that is; empty if it is in.
[[nodiscard]] std::string unknown_claim(const std::string &name);

/// Names of all claims as the help shows them: "{energy,wave-speeds}".
[[nodiscard]] std::string claim_choices();

/// A line for each claim, with its title, for the help.
[[nodiscard]] std::string claim_list();

/// Writes claims.json, titles and statements for the report, into `folder`, which must exist. @throws OutputError
void write_claims(const std::vector<claims::Claim> &claims, const std::string &folder);

} // namespace latcon::commands
