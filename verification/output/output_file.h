/// Files in an output directory, and the list of those that latcon wrote, so that files of a later run are not mixed
/// with those of an earlier one.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace latcon::output
{

/// Replaces the file `path` by `text` and synchronises it with the disk; see support::AtomicFile. First adds the file
/// to the list of its folder, if the folder has one; a file that was not listed is moved to a folder `earlier-run`.
/// @throws OutputError with `path` and the reason given by the system; the old file is unchanged
void write_file(const std::string &path, const std::string &text);

/// Paths and texts of files.
using TextFiles = std::vector<std::pair<std::string, std::string>>;

/// Replaces files one after the other, each as write_file() does.
void write_files(const TextFiles &files);

/// Name of the list in an output directory: sorted, with a line per file that latcon wrote. A `*` represents the digits
/// and dots in the number of a frame.
inline constexpr const char *output_list_name = ".latcon-files";

/// Returns true if a file is in the list of its folder.
[[nodiscard]] bool is_listed_output(const std::filesystem::path &file);

/// Creates the list of an output directory with the names of frames and fields, or adds them. Files of these
/// names that were not listed are moved aside.
/// @throws OutputError
void begin_output_list(const std::filesystem::path &folder);

/// Moves the checkpoints in an output directory to its subfolder `checkpoints.old`, which they replace, and the listed
/// files to `earlier-run`, or if that exists to `earlier-run-2` and so on. Files that are not listed are not moved.
/// @param keep file that is not moved, listed or not; may be empty
/// @return the folder of the files, or an empty path if there were none
/// @throws OutputError
std::filesystem::path archive_earlier_output(const std::filesystem::path &folder, const std::filesystem::path &keep);

} // namespace latcon::output
