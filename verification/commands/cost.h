#pragma once

#include "verification/input/options.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{

/// Estimated time above which a run is refused unless the user confirms it by `--yes` [s]: 10 days.
inline constexpr double longest_run = 10. * 86400.;

/// Refuses a run that needs more memory than the machine has, unless the user confirmed it. Collective.
/// @throws InputError with both numbers
void require_memory(const input::Options &options, const resources::MemoryNeed &need);

/// Refuses a run that takes longer than longest_run, unless the user confirmed it. @param seconds estimated
/// @throws InputError with the estimate
void require_time(const input::Options &options, double seconds);

/// Rough time of a crack or a motion of the lattice on this machine [s], from the number of force evaluations; nothing
/// is measured. @param steps that are expected
[[nodiscard]] double rough_seconds(const input::Case &input, const lattice::TimeStepping &stepping, double steps);

} // namespace latcon::commands
