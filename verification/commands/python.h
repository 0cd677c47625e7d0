#pragma once

#include <string>
#include <vector>

namespace latcon::commands
{

/// Returns the path of the Python interpreter: the environment variable LATCON_PYTHON, or that of Debian.
[[nodiscard]] std::string python_interpreter();

/// Returns the sorted names of the shipped studies, which are in the data folder.
[[nodiscard]] std::vector<std::string> shipped_studies();

} // namespace latcon::commands
