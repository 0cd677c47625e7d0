#pragma once

#include <string>
#include <vector>

namespace latcon::commands
{

/// Returns the path of the Python interpreter: the environment variable LATCON_PYTHON, or that of Debian.
[[nodiscard]] std::string python_interpreter();

/// Returns the folder that contains the Python package: in the data folder, or in the source tree. @throws OutputError
[[nodiscard]] std::string package_folder();

/// Returns the environment of the user without variables that would change the interpreter or matplotlib, and with the
/// path of the package.
[[nodiscard]] std::vector<std::string> environment_of_python(const std::string &package);

} // namespace latcon::commands
