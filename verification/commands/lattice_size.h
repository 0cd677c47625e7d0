#pragma once

#include <string>

#include "verification/case.h"

namespace verification
{

/// What `--dry-run` says of the lattice of a case: sites, bonds, time step, stages, steps, memory and time it will
/// take.
std::string lattice_size(const Case &input, const lattice::TimeStepping &stepping);

/// Time that so many evaluations of the forces on a site take on one core, time stepping included, estimated [s].
double core_seconds(double site_evaluations);

} // namespace verification
