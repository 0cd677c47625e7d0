/// Memory and time that a run will take, estimated before it starts: one estimate for what --dry-run prints and for
/// what is refused.
#pragma once

#include <cstddef>
#include <string>

#include "verification/input/case.h"

namespace latcon::resources
{

/// What is computed with a lattice.
enum class RunKind
{
  equilibrium, ///< `latcon lattice`, equilibrium
  dynamics,    ///< `latcon lattice`, motion
  fracture     ///< `latcon fracture`
};

/// Memory of a run, beyond what its processes hold before it starts [bytes].
struct MemoryNeed
{
  double shared = 0.;     ///< divided among all ranks
  double first_rank = 0.; ///< of the first rank besides
};

/// Of a lattice: fields of all places, and a frame of all sites, or the image of a checkpoint, on the first rank.
/// @param claims whether the claims are checked before the crack
[[nodiscard]] MemoryNeed lattice_memory(const input::Case &input, RunKind run, bool claims = false);

/// A finite element problem, as far as its cost depends on it.
struct ContinuumSize
{
  double cells = 0.;           ///< at the start
  double coarse_unknowns = 0.; ///< of the mesh that multigrid solves directly; all, if there is no multigrid
  double unknowns = 0.;        ///< at the start
  double final_unknowns = 0.;  ///< after the adaptive cycles
};

/// Sizes of the finite element problem of a case, before there is a mesh: a mesh may be larger than the memory.
/// @throws InputError for more unknowns than can be numbered; continuum::InvalidInput if a mesh file cannot be read
[[nodiscard]] ContinuumSize continuum_size(const input::Case &input);

/// Of a finite element sheet of that size.
[[nodiscard]] MemoryNeed continuum_memory(const input::Case &input, const ContinuumSize &size);

/// Refuses a run that this machine has no memory for. Ranks that share a machine add up. Collective: all ranks throw,
/// or none.
/// @throws InputError with what is needed and what there is
void require_memory(const MemoryNeed &need);

/// "# memory: ..." for a dry run: peak of all ranks on the first rank's machine, libraries included. Collective.
[[nodiscard]] std::string memory_text(const MemoryNeed &need);

/// Time that a run of the lattice will take [s], here and now: the kernel is run on a small sheet of the same case for
/// some tenths of a second. Collective.
/// @param steps expected number of time steps
/// @param frames number of frames written
[[nodiscard]] double lattice_seconds(const input::Case &input, const lattice::TimeStepping &stepping, RunKind run,
                                     double steps, double frames);

/// The claims in their small versions, and the pictures and the page of a crack, on one core [s].
inline constexpr double seconds_of_claims = 8., seconds_of_report = 9.; ///< see above

/// Steps that a crack as fast as the shear waves of the unloaded sheet takes to the stop position, at most all.
[[nodiscard]] double expected_steps(const input::Case &input, const lattice::TimeStepping &stepping);

/// Parts into which the first step is divided because bonds of the loaded sheet are short (theory.md, eq. (L.24)); 1:
/// none.
[[nodiscard]] double parts_of_first_step(const input::Case &input, const lattice::TimeStepping &stepping, RunKind run);

/// Time that a finite element run takes [s], from costs per unknown and iteration that were measured on one core.
/// @param steps of a motion; 0 for an equilibrium
/// @param frames number of frames written
[[nodiscard]] double continuum_seconds(const input::Case &input, const ContinuumSize &size, double steps,
                                       double frames);

/// Time that so many evaluations of the forces on a site take on one core, time stepping included, estimated [s].
[[nodiscard]] double core_seconds(double site_evaluations);

/// Reports `Time/end` if a motion would have more steps than can be counted. @param step [s], > 0
void check_steps(const input::Case &input, double step, input::Parameters &parameters);

} // namespace latcon::resources
