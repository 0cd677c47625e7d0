#pragma once

#include <string>

#include "verification/case.h"

namespace verification
{

/// What `--dry-run` says of the lattice of a case: sites, bonds, time step, steps, memory and time it will take.
std::string lattice_size(const Case &input, double time_step);

/// Time that so many site-steps take on one core, estimated [s].
double core_seconds(double site_steps);

} // namespace verification
