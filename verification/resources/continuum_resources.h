/// Estimates of the memory and the time of a finite element run.
#pragma once

#include "verification/resources/resources.h"

namespace latcon::resources
{

/// Size of a finite element problem.
struct ContinuumSize
{
  double cells = 0.;           ///< at the start
  double coarse_unknowns = 0.; ///< of the coarsest mesh, which is solved directly; all unknowns without multigrid
  double unknowns = 0.;        ///< at the start
  double final_unknowns = 0.;  ///< after the adaptive cycles
};

/// Computes the size of the finite element problem of a case without generating its mesh, which may not fit into
/// memory.
/// @throws InputError if the number of unknowns exceeds the range of their indices; continuum::InvalidInput if a mesh
/// file cannot be read
[[nodiscard]] ContinuumSize continuum_size(const input::Case &input);

/// Estimates the memory of a finite element run of that size.
[[nodiscard]] MemoryNeed continuum_memory(const input::Case &input, const ContinuumSize &size);

/// Estimates the wall time of a finite element run [s] from measured costs per unknown and iteration on one core.
/// @param steps number of time steps; 0 for an equilibrium
/// @param frames number of frames written
[[nodiscard]] double continuum_seconds(const input::Case &input, const ContinuumSize &size, double steps,
                                       double frames);

} // namespace latcon::resources
