#pragma once

#include "continuum/sheet.h"
#include "verification/bridge/continuum_model.h"
#include "verification/commands/command.h"

namespace latcon::commands
{

/// Finds the equilibrium of a case and writes its frames and tables, on every rank alike.
/// @throws continuum::SolverFailed after what was found has been written
output::Results equilibrium(const input::Case &input, bridge::ContinuumModel &model, output::Checkpoints &checkpoints,
                            Run &run);

/// Nodal displacement [m] of the equilibrium under the boundary conditions of the case. @throws continuum::SolverFailed
continuum::Sheet::Vector equilibrium_displacement(const input::Case &input, const bridge::ContinuumModel &model,
                                                  const continuum::Sheet &sheet, Run &run);

} // namespace latcon::commands
