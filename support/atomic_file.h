/// Atomic replacement of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "support/errors.h"

namespace latcon::support
{

/// Synchronisation of a file and its name with the disk (several milliseconds), so that they survive a power failure.
enum class Sync
{
  no,
  yes
};

/// File that is written under a temporary name, `NAME.RANDOM.part` in the same folder, and renamed when it is complete.
/// At any moment, also after a kill or on a full disk, `NAME` is either the old file or the complete new one.
///
/// The part is always created (O_CREAT | O_EXCL | O_NOFOLLOW) and has an unpredictable name, so a link or file that
/// another user puts there is never written to. A link at the destination is replaced, not followed. A killed process
/// leaves its part behind; see remove_stale_parts().
class AtomicFile
{
public:
  /// Creates the part for the file `place`. @throws OutputError, also if `place` is a folder, a device or a pipe, which
  /// renaming would destroy, or if it is in a folder that this process has locked and that has since been removed or
  /// replaced
  explicit AtomicFile(std::filesystem::path place);

  /// Removes the part unless it was committed.
  ~AtomicFile();

  AtomicFile(const AtomicFile &) = delete;
  AtomicFile &operator=(const AtomicFile &) = delete;

  /// Appends to the part. @throws OutputError
  void write(std::string_view bytes);

  /// Returns a name under which a library can open and truncate the part: that of the descriptor in /proc, which refers
  /// to this file even if the folder is renamed or the part replaced in the meantime.
  [[nodiscard]] std::string name() const;

  /// Renames the part to the destination. To be called once, as the last function.
  /// @throws OutputError; the part is then removed
  void commit(Sync sync);

private:
  void discard();

  std::filesystem::path place_, part_;
  int descriptor_ = -1; // -1: closed
};

/// Replaces the file `place` atomically by `text`. @throws OutputError
void write_atomically(const std::filesystem::path &place, std::string_view text, Sync sync);

/// Creates a folder and those above it, unless they exist. @throws OutputError
void create_folders(const std::filesystem::path &folder);

/// Removes the parts in `folder` that were last written before `moment`, which must be earlier than all writes of
/// processes that still run. In a folder that only this process writes (FolderLock) any moment will do.
/// @return number of removed parts; parts that cannot be removed are skipped
std::size_t remove_stale_parts(const std::filesystem::path &folder, std::filesystem::file_time_type moment);

} // namespace latcon::support
