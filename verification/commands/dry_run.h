#pragma once

#include <string>

#include "verification/input/case.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{

/// Output of `--dry-run` for the lattice of a case, without memory: sites, bonds, time step, stages, steps and
/// estimated time. Collective; the sheet must fit into the memory.
/// @param claims, report whether claims are checked before the crack, and its page is drawn afterwards
std::string lattice_text(const input::Case &input, const lattice::TimeStepping &stepping, resources::RunKind run,
                         bool claims = false, bool report = false);

} // namespace latcon::commands
