/// Cores that this process may run on.
#pragma once

namespace latcon::support
{

/// Returns the number of hardware threads that the scheduler may give to this process (sched_getaffinity), at least 1:
/// fewer than the machine has under `taskset`, in a cpuset, and where a launcher binds ranks to cores.
[[nodiscard]] unsigned int available_cores();

/// Returns this rank's share of the hardware threads of its machine, at least 1: those that any of the machine's ranks
/// may run on, divided by their number. Collective over MPI_COMM_WORLD.
[[nodiscard]] unsigned int available_cores_per_rank();

} // namespace latcon::support
