/// Atomic replacement of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "support/errors.h"

namespace latcon::support
{

/// Whether a file and its name are forced to the disk (some milliseconds), so that they also survive a power failure.
enum class Sync
{
  no,
  yes
};

/// A file that is written beside its place, as `NAME.RANDOM.part` in the same folder, and renamed once it is whole. At
/// any moment, also after a kill or on a full disk, the place holds the old file or the new one.
///
/// The part is created (O_CREAT | O_EXCL | O_NOFOLLOW), never opened, under a name that nobody can foresee: no link or
/// file that others put there is written to. Links in the place itself are replaced, not followed. A killed process
/// leaves its part behind; see remove_stale_parts().
class AtomicFile
{
public:
  /// Creates the part. @throws OutputError, also if the place is a folder, a device or a pipe, which renaming would
  /// destroy, or in a folder that this process has locked and that was removed or replaced since
  explicit AtomicFile(std::filesystem::path place);

  /// Removes the part unless it was committed.
  ~AtomicFile();

  AtomicFile(const AtomicFile &) = delete;
  AtomicFile &operator=(const AtomicFile &) = delete;

  /// Appends to the part. @throws OutputError
  void write(std::string_view bytes);

  /// Name under which a library that opens files by name can open and truncate the part: that of the descriptor in
  /// /proc, so that it is this file even if the folder is renamed or the part replaced meanwhile.
  [[nodiscard]] std::string name() const;

  /// Renames the part into its place. To be called once, as the last.
  /// @throws OutputError; the part is then removed
  void commit(Sync sync);

private:
  void discard();

  std::filesystem::path place_, part_;
  int descriptor_ = -1; // -1: closed
};

/// Replaces the file `place` by `text`. @throws OutputError
void write_atomically(const std::filesystem::path &place, std::string_view text, Sync sync);

/// Removes the parts in `folder` that were last written before `moment`. Parts of living processes must be younger: in
/// a folder that this process alone writes (FolderLock) that is any moment.
/// @return how many were removed; those that cannot be removed stay
std::size_t remove_stale_parts(const std::filesystem::path &folder, std::filesystem::file_time_type moment);

} // namespace latcon::support
