#pragma once

#include <memory>

#include "continuum/dynamic_solver.h"
#include "verification/bridge/continuum_model.h"
#include "verification/commands/command.h"

namespace latcon::commands
{

/// Time step of a motion [s]: that of the case, or the one that resolves the waves that the mesh resolves, and the fastest
/// relaxation: half the time in which a longitudinal wave crosses a cell, at most a tenth of the shortest relaxation time
/// (theory-continuum.md, "Default time step").
double motion_time_step(const input::Case &input, bridge::ContinuumModel &model);

/// Sheet of finite elements that moves, before its first step, whose input is valid.
struct MovingSheet
{
  continuum::DynamicSettings settings;
  std::unique_ptr<continuum::Viscosity> viscosity;
  std::unique_ptr<continuum::FibreMemory> memory;
  continuum::DynamicSolver solver;
  continuum::Sheet::Vector added, velocity; ///< nodal fields that are added to the base state [m, m/s]

  /// @throws InputError, continuum::InvalidInput for what start() would refuse
  MovingSheet(const input::Case &input, bridge::ContinuumModel &model);

  /// Gives it the initial state of the case.
  void start(const input::Case &input, const bridge::ContinuumModel &model, Run &run);
};

/// Moves the sheet until the end time. @return results at the end, or where a signal interrupted it
output::Results motion(const input::Case &input, const bridge::ContinuumModel &model, MovingSheet &sheet,
                       output::Checkpoints &checkpoints, Run &run);

/// Finds the equilibrium of a case and writes its frames and tables, on every rank alike.
/// @throws continuum::SolverFailed after what was found has been written
output::Results equilibrium(const input::Case &input, bridge::ContinuumModel &model, Run &run);

/// Nodal displacement [m] of the equilibrium under the boundary conditions of the case. @throws continuum::SolverFailed
continuum::Sheet::Vector equilibrium_displacement(const input::Case &input, const bridge::ContinuumModel &model,
                                                  const continuum::Sheet &sheet, Run &run);

} // namespace latcon::commands
