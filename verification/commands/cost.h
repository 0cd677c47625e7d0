#pragma once

#include "verification/input/options.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{

/// Refuses a run that needs more memory than the machine has, unless the user confirmed it. Collective.
/// @throws InputError with both numbers
void require_memory(const input::Options &options, const resources::MemoryNeed &need);

/// Refuses a run that takes longer than 10 days, unless the user confirmed it. @param seconds estimated
/// @throws InputError with the estimate
void require_time(const input::Options &options, double seconds);

/// Refuses a run of the lattice as require_memory() and require_time() do, and prints what --dry-run shows: the
/// resolved case, memory, sites, bonds, time step, stages, steps and estimated time. Collective.
/// @return whether it is to be run; false with --dry-run
[[nodiscard]] bool is_to_be_run(const input::Options &options, const input::Parameters &parameters,
                                const input::Case &input, const lattice::TimeStepping &stepping,
                                resources::RunKind run);

} // namespace latcon::commands
