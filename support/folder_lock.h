/// Exclusive locks on folders.
#pragma once

#include <chrono>
#include <filesystem>

#include "support/errors.h"

namespace latcon::support
{

/// Exclusive, advisory lock on a folder: a lock (flock) on the file `.latcon.lock` in it, which contains the process ID
/// and the name of the machine while the lock is held. The lock is released with the object and when the process ends
/// for any reason; the file remains. Child processes do not inherit the lock.
///
/// On NFS the lock is valid on all machines if the server runs its lock service. On a file system without locks
/// is_held() is false and the folder is not protected.
class FolderLock
{
public:
  /// Locks an existing folder. Waits up to `patience` for another process to release the lock.
  /// @throws InputError if that does not happen @throws OutputError if the lock file cannot be created or is not a
  /// regular file
  explicit FolderLock(std::filesystem::path folder, std::chrono::milliseconds patience = std::chrono::seconds(1));
  ~FolderLock();

  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

  [[nodiscard]] bool is_held() const { return is_held_; }

  /// Returns true if the path still refers to the locked folder, which was neither removed nor replaced.
  [[nodiscard]] bool is_in_place() const;

private:
  std::filesystem::path folder_;
  std::filesystem::path name_; // absolute
  int descriptor_ = -1;
  bool is_held_ = false;
};

/// Checks that `place` can be written: throws OutputError if it is in or below a folder that this process has locked
/// and that has since been removed or replaced. A folder that has this name now may belong to another process.
/// Thread-safe.
void require_in_place(const std::filesystem::path &place);

} // namespace latcon::support
