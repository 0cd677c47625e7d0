/// Commands that compute with finite elements.
#pragma once

#include "support/errors.h"
#include "verification/input/options.h"

namespace latcon::commands
{

support::ExitCode run_continuum(const input::Options &options);          ///< `latcon continuum`

} // namespace latcon::commands
