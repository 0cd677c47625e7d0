/// Input files of the user: cases and studies.
#pragma once

#include <string>

namespace latcon::input
{

/// Content of a file, or the reason why it could not be read.
struct InputFile
{
  std::string text;
  std::string problem; ///< empty if the file was read
};

/// Reads a file of at most 16 MiB. Of a longer one, such as an endless device, no more than that is read.
[[nodiscard]] InputFile read_input_file(const std::string &path);

} // namespace latcon::input
