/// Estimates of the memory and the time of a run before it starts, for the output of --dry-run and for the memory
/// check.
#pragma once

#include <string>

#include "verification/input/case.h"

namespace latcon::resources
{

/// Kind of run of a lattice.
enum class RunKind
{
  equilibrium, ///< `latcon lattice`, equilibrium
  dynamics,    ///< `latcon lattice`, motion
  fracture     ///< `latcon fracture`
};

/// Memory that a run needs in addition to the current memory of its processes [bytes].
struct MemoryNeed
{
  double shared = 0.;     ///< divided among all ranks
  double first_rank = 0.; ///< additional memory on the root rank
};

/// Estimates the memory of a lattice run: fields of all slots and, on the root rank, a frame of all sites or the image
/// of a checkpoint.
/// @param claims true if the claims are checked before the crack
[[nodiscard]] MemoryNeed lattice_memory(const input::Case &input, RunKind run, bool claims = false);

/// Returns the bytes of the history of bonds per slot.
[[nodiscard]] double bytes_of_history(const lattice::Material &material, const lattice::TriangularLattice &sheet);

/// Wall time of the start of the program [s].
inline constexpr double seconds_of_start = 0.5;

/// Checks that the machine has enough memory for a run, summed over the ranks on the machine. Collective: all ranks
/// throw, or none.
/// @throws InputError with the needed and the available memory
void require_memory(const MemoryNeed &need);

/// Returns the line "# memory: ..." of a dry run: peak memory of all ranks on the machine of the root rank, libraries
/// included. Collective.
[[nodiscard]] std::string memory_text(const MemoryNeed &need);

/// Estimates the wall time of a lattice run [s] from the number of its force evaluations.
/// @param steps expected number of time steps
/// @param frames number of frames written
[[nodiscard]] double lattice_seconds(const input::Case &input, const lattice::TimeStepping &stepping, RunKind run,
                                     double steps, double frames);

/// Wall time of the small versions of the claims, and of the pictures and the page of a crack, on one core [s].
inline constexpr double seconds_of_claims = 15., seconds_of_report = 4.; ///< for the pictures and the page

/// Returns the number of steps in which a crack at the shear wave speed of the unloaded sheet reaches the stop
/// position, at most all steps of the run.
[[nodiscard]] double expected_steps(const input::Case &input, const lattice::TimeStepping &stepping);

/// Returns the number of substeps of the first step that short bonds of the loaded sheet require (theory.md, eq.
/// (L.24)); 1 if it is not divided.
[[nodiscard]] double parts_of_first_step(const input::Case &input, const lattice::TimeStepping &stepping, RunKind run);

/// Estimates the time [s] on one core of a number of evaluations of the forces on a sheet, time stepping included.
[[nodiscard]] double core_seconds(const input::Case &input, double evaluations);

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

/// Reports `Time/end` to `parameters` if the number of steps exceeds the range of the counter. @param step [s], > 0
void check_steps(const input::Case &input, double step, input::Parameters &parameters);

} // namespace latcon::resources
