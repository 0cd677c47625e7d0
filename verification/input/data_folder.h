#pragma once

#include <string>

namespace latcon::input
{

/// Folder of the data files: cases/, studies/, report/, paraview/. It is the nearest share/latcon above the running
/// program; the build folder has one that links to the sources. If none exists, the folder where an installation would
/// have it.
std::string data_folder();

} // namespace latcon::input
