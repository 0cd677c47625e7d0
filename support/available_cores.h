/// Number of cores available to this process.
#pragma once

#include <filesystem>

namespace latcon::support
{

/// Returns the processor time that the control groups of this process allow (cpu.max, or cpu.cfs_quota_us of version
/// 1), in units of one core: 0.5 in a container that may use half a core. Infinity without limit.
/// @param root folder that contains /proc and /sys; tests pass their own
[[nodiscard]] double processor_quota(const std::filesystem::path &root = "/");

/// Returns the number of hardware threads on which this process may run (sched_getaffinity), at least 1 and at most its
/// quota. It is smaller than that of the machine under `taskset`, in a cpuset, and if a launcher binds ranks to cores.
[[nodiscard]] unsigned int available_cores();

/// Returns this rank's share of the hardware threads of its machine, at least 1: the number of threads on which any
/// rank of the machine may run, divided by the number of these ranks. Collective over MPI_COMM_WORLD.
[[nodiscard]] unsigned int available_cores_per_rank();

} // namespace latcon::support
