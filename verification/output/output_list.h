/// Which files of an output directory latcon wrote, so that a later run there does not mix with an earlier one.
#pragma once

#include <filesystem>
#include <string>

namespace latcon::output
{

/// Name of the list in an output directory: a line for each file that latcon wrote, sorted. A `*` represents the digits
/// and dots that number a frame.
inline constexpr const char *output_list_name = ".latcon-files";

/// Whether a file is in the list of its folder.
[[nodiscard]] bool is_listed_output(const std::filesystem::path &file);

/// Begins the list of an output directory with the names of frames and fields, or keeps the one that is there.
/// @throws OutputError
void begin_output_list(const std::filesystem::path &folder);

/// Puts a file into the list of its folder; nothing if the folder has none. To be called before the file is written.
/// @throws OutputError
void list_output(const std::filesystem::path &file);

/// Moves the files that the list of an output directory names into a folder in it: `earlier-run`, or if that exists
/// `earlier-run-2` and so on. Files that are not listed stay.
/// @param keep a file that stays where it is, listed or not; may be empty
/// @return the folder, or an empty path if there was nothing to move
/// @throws OutputError
std::filesystem::path set_earlier_output_aside(const std::filesystem::path &folder, const std::filesystem::path &keep);

} // namespace latcon::output
