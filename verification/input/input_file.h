/// Files that a user wrote: cases and studies.
#pragma once

#include <string>

namespace latcon::input
{

/// Content of a file, or why it could not be read.
struct InputFile
{
  std::string text;
  std::string problem; ///< empty if the file was read
};

/// Reads a file of at most 16 MiB; of a longer one, also of a device without end, no more than that is read.
[[nodiscard]] InputFile read_input_file(const std::string &path);

} // namespace latcon::input
