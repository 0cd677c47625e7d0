/// Control groups of this process, in which systems and containers limit memory and processor time.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace latcon::support
{

/// Calls `visit` with the folder of each control group of this process that has a controller, and of the groups around
/// it, of version 1 or 2. In a container the folder of the group may not exist under the name given by the system; the
/// group is then the mounted root.
/// @param root folder that contains /proc and /sys
/// @param controller name in version 1: "memory", "cpu"
/// @param visit receives the folder and the version, 1 or 2, on which names of files depend
void for_each_control_group(const std::filesystem::path &root, const std::string &controller,
                            const std::function<void(const std::filesystem::path &group, int version)> &visit);

} // namespace latcon::support
