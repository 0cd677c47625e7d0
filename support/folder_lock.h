/// Folders that one process at a time writes.
#pragma once

#include <chrono>
#include <filesystem>

#include "support/errors.h"

namespace latcon::support
{

/// Exclusive right to write to a folder: a lock (flock) on the file `.latcon.lock` in it, which meanwhile holds the
/// number of the process and the name of its machine. The lock ends with the object and with the process, however that
/// ends; the file stays. Only processes that ask for the lock respect it. Children do not inherit it.
///
/// Over NFS the lock holds on all machines if the server runs its lock service. Where a file system has no locks,
/// is_held() is false and nothing is protected.
class FolderLock
{
public:
  /// Locks an existing folder. Waits up to `patience` for a process that is about to end.
  /// @throws FolderInUse @throws OutputError if the lock file cannot be made, or is no regular file
  explicit FolderLock(std::filesystem::path folder, std::chrono::milliseconds patience = std::chrono::seconds(1));
  ~FolderLock();

  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

  [[nodiscard]] bool is_held() const { return is_held_; }

  /// Returns whether the path still leads to the folder that was locked: it was neither removed nor replaced.
  [[nodiscard]] bool is_in_place() const;

private:
  std::filesystem::path folder_;
  std::filesystem::path name_; // absolute
  int descriptor_ = -1;
  bool is_held_ = false;
};

/// Throws OutputError if `place` is in a folder that this process has locked, or below one, and the folder was removed
/// or replaced since: what has its name now may belong to another process. May be called from any thread.
void require_in_place(const std::filesystem::path &place);

} // namespace latcon::support
