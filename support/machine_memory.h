/// Memory of the machine and of the process.
#pragma once

#include <filesystem>
#include <string>

namespace latcon::support
{

/// Returns the memory that this process may still allocate [bytes]: the available memory of the system (MemAvailable of
/// /proc/meminfo), or the remainder of the limits of its control groups (version 1 or 2) where that is less. Page cache
/// counts as free.
/// @param root folder that contains /proc and /sys; tests pass their own
/// @return infinity if the system does not report it
[[nodiscard]] double available_memory(const std::filesystem::path &root = "/");

/// Returns the resident memory of this process [bytes]; 0 if the system does not report it.
[[nodiscard]] double resident_memory();

/// Formats a number of bytes with three digits and a unit: "1.5 GB".
[[nodiscard]] std::string readable_bytes(double bytes);

} // namespace latcon::support
