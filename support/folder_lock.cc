#include "support/folder_lock.h"

#include <array>
#include <cerrno>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace latcon::support
{
namespace
{

const char *const lock_name = ".latcon.lock";
constexpr std::chrono::milliseconds poll_interval(20);

// Returns the process ID and machine in the lock file, up to the first character that latcon does not write there.
std::string owner_in(int descriptor)
{
  std::array<char, 300> text{};
  const ssize_t n = ::pread(descriptor, text.data(), text.size() - 1, 0);
  const std::string line = n > 0 ? text.data() : "";
  const std::size_t end = line.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-._ ");
  return line.substr(0, end);
}

int open_lock_file(const std::filesystem::path &path)
{
  // O_NONBLOCK: opening a pipe at this path must not block.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (descriptor < 0)
    throw OutputError(path, std::generic_category().message(errno));
  struct stat status
  {
  };
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
    return descriptor;
  ::close(descriptor);
  throw OutputError(path, "it is not a regular file");
}

// Locks held by this process, by folder.
struct HeldLocks
{
  std::mutex mutex;
  std::map<std::filesystem::path, const FolderLock *> by_folder;
};

HeldLocks &held_locks()
{
  static HeldLocks locks;
  return locks;
}

// Returns the normalised absolute path of a folder; symbolic links are not resolved.
std::filesystem::path name_of_folder(const std::filesystem::path &folder)
{
  std::error_code none; // if the current folder was removed
  return (std::filesystem::absolute(folder, none) / "").lexically_normal().parent_path();
}

// Replaces the content of a lock file, which is informative only; the lock does not depend on it.
void write_owner(int descriptor, const std::string &owner)
{
  struct stat status
  {
  };
  if (::fstat(descriptor, &status) != 0 || status.st_nlink > 1)
    return; // the file has other hard links
  const bool is_written = ::ftruncate(descriptor, 0) == 0 && ::pwrite(descriptor, owner.data(), owner.size(), 0) >= 0;
  (void)is_written;
}

bool is_same_file(int descriptor, const std::filesystem::path &path)
{
  struct stat open
  {
  }, there{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &there) == 0 && open.st_dev == there.st_dev &&
         open.st_ino == there.st_ino;
}

} // namespace

FolderLock::FolderLock(std::filesystem::path folder, std::chrono::milliseconds patience)
  : folder_(std::move(folder)), name_(name_of_folder(folder_))
{
  const std::filesystem::path path = folder_ / lock_name;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  descriptor_ = open_lock_file(path);
  while (!is_held_)
  {
    const bool is_locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (!is_locked && errno != EWOULDBLOCK && errno != EINTR)
      return; // no locks on this file system
    // The file may have been removed or replaced between the two calls, which makes its lock useless.
    is_held_ = is_locked && is_same_file(descriptor_, path);
    if (is_held_)
      break;
    const std::string owner = is_locked ? "" : owner_in(descriptor_);
    ::close(std::exchange(descriptor_, -1));
    if (std::chrono::steady_clock::now() >= deadline)
      throw InputError(folder_.string() + " is in use by " + (owner.empty() ? "another process" : "process " + owner) +
                       "; wait until it has ended, or choose another folder (--output-dir)");
    std::this_thread::sleep_for(poll_interval);
    descriptor_ = open_lock_file(path);
  }
  std::array<char, 256> machine{};
  ::gethostname(machine.data(), machine.size() - 1);
  write_owner(descriptor_, std::to_string(::getpid()) + " on " + machine.data() + "\n");
  const std::lock_guard<std::mutex> guard(held_locks().mutex);
  held_locks().by_folder[name_] = this;
}

FolderLock::~FolderLock()
{
  if (is_held_)
  {
    const std::lock_guard<std::mutex> guard(held_locks().mutex);
    held_locks().by_folder.erase(name_);
    write_owner(descriptor_, ""); // the folder of a finished run must not depend on the process that wrote it
  }
  ::close(descriptor_);
}

bool FolderLock::is_in_place() const
{
  return is_same_file(descriptor_, folder_ / lock_name);
}

void require_in_place(const std::filesystem::path &place)
{
  const std::lock_guard<std::mutex> guard(held_locks().mutex);
  for (std::filesystem::path folder = name_of_folder(place); folder.has_relative_path(); folder = folder.parent_path())
  {
    const auto lock = held_locks().by_folder.find(folder);
    if (lock != held_locks().by_folder.end() && !lock->second->is_in_place())
      throw OutputError(place, "the folder " + folder.string() + " was removed or replaced during the run");
  }
}

} // namespace latcon::support
