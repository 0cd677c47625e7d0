/// Atomic writing of text files.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace latcon::output
{

/// Replaces the file `path` by `text` and synchronises it with the disk; see support::AtomicFile. First adds the file
/// to the list of its folder (output_list.h).
/// @throws OutputError with `path` and the reason given by the system; the old file is unchanged
void write_file(const std::string &path, const std::string &text);

/// Paths and texts of files.
using TextFiles = std::vector<std::pair<std::string, std::string>>;

/// Replaces files one after the other, each as write_file() does.
void write_files(const TextFiles &files);

} // namespace latcon::output
