#pragma once

#include <string>

#include "verification/input/case.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{

/// What `--dry-run` says of the lattice of a case beside memory: sites, bonds, time step, stages, steps and time it
/// will take. Collective; the sheet must fit into the memory.
/// @param claims, report whether a crack has its claims checked before, and its page drawn afterwards
std::string lattice_text(const input::Case &input, const lattice::TimeStepping &stepping, resources::RunKind run,
                         bool claims = false, bool report = false);

} // namespace latcon::commands
