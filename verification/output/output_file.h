/// Text files of a run, replaced atomically.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace latcon::output
{

/// Replaces the file `path` by `text`, forced to the disk; see support::AtomicFile. The file is listed in its
/// folder first (output_list.h).
/// @throws OutputError naming `path` and the system's reason; the old file is untouched.
void write_file(const std::string &path, const std::string &text);

/// The same for a text that `writer` prints. Nothing is written if `writer` throws; what it throws is passed on.
/// The whole text is held in memory. The stream prints doubles with six digits unless told otherwise; see
/// full_precision().
/// @throws OutputError as above, and if `writer` leaves the stream in a failed state.
void write_file(const std::string &path, const std::function<void(std::ostream &)> &writer);

} // namespace latcon::output
