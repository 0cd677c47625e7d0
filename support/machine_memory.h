/// What the machine has left for a run.
#pragma once

#include <filesystem>
#include <string>

namespace latcon::support
{

/// Memory that a process may still take [bytes]: what the system has available (MemAvailable of /proc/meminfo), or what
/// its control groups, version 1 or 2, leave, where that is less. Memory that only caches files counts as free.
/// @param root where /proc and /sys are looked for; tests have trees of their own
/// @return infinity if the system does not say
[[nodiscard]] double available_memory(const std::filesystem::path &root = "/");

/// Memory that this process holds now [bytes]; 0 if the system does not say.
[[nodiscard]] double held_memory();

/// "1.5 GB", three digits.
[[nodiscard]] std::string readable_bytes(double bytes);

} // namespace latcon::support
