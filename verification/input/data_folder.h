#pragma once

#include <string>

namespace latcon::input
{

/// The folder that holds what latcon reads: cases/, studies/, report/, paraview/. It is the nearest share/latcon above
/// the running program, wherever that was installed to; the build folder has one that leads to the sources. Where there
/// is none, the place where an installation would have it.
std::string data_folder();

} // namespace latcon::input
