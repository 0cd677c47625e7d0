#pragma once

#include <functional>

#include "lattice/contact.h"
#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Returns rows of the claim `energy` on the contact of a case: two free sites that fly at each other part with the
/// coefficient of restitution of theory.md, eq. (L.13), from the constants of bonds and contact alone, and with the
/// momentum and the energy that they had, what the dashpot took included. By the integrator of the case, with its step
/// or a shorter one that resolves the contact.
/// @param input has contact
/// @param planted error that a test introduces into the contact law of the simulator; none otherwise
[[nodiscard]] output::Results contact_rows(const bridge::Subject &subject, const input::Case &input,
                                           const std::function<void(lattice::ContactLaw &)> &planted = {});

} // namespace latcon::claims
