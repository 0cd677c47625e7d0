#pragma once

#include <string>

namespace latcon::input
{

/// Folder of the data files: cases/, studies/, report/, paraview/. It is the nearest share/latcon above the running
/// program; the build folder has one that links to the sources. If none exists, the folder where an installation would
/// have it.
std::string data_folder();

/// Name of the module with the finite elements, which the program loads on demand.
inline constexpr const char *module_name = "latcon_elements.so";

/// Returns the path of the module beside the program, or in lib/latcon beside its folder, where it is installed; empty:
/// there is none.
[[nodiscard]] std::string module_file();

} // namespace latcon::input
