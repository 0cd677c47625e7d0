#include "support/atomic_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/folder_lock.h"

namespace latcon::support
{
namespace
{

namespace fs = std::filesystem;

constexpr std::size_t n_digits = 16; // hexadecimal digits in the random part of a name
const std::string suffix = ".part";

// Creates an error with the message of the system for an error number; std::strerror is not thread-safe.
OutputError error_of(const fs::path &place, int error_number)
{
  return {place, std::generic_category().message(error_number)};
}

fs::path random_neighbour(const fs::path &place)
{
  std::random_device random; // of the system: not predictable
  std::array<char, n_digits + 1> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x%08x", random(), random());
  return place.string() + "." + digits.data() + suffix;
}

bool is_name_of_part(const std::string &name)
{
  const std::size_t length = 1 + n_digits + suffix.size(); // length after the name of the file
  return name.size() > length && name[name.size() - length] == '.' &&
         name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0 &&
         std::all_of(name.end() - static_cast<std::ptrdiff_t>(length - 1),
                     name.end() - static_cast<std::ptrdiff_t>(suffix.size()),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

// Synchronises the folder of a file with the disk. Errors are ignored, because the file is complete in any case.
void sync_folder_of(const fs::path &file)
{
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  ::fsync(descriptor);
  ::close(descriptor);
}

} // namespace

AtomicFile::AtomicFile(fs::path place) : place_(std::move(place))
{
  struct stat status
  {
  };
  if (::stat(place_.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw OutputError(place_, S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file");
  do
  {
    part_ = random_neighbour(place_);
    descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ < 0)
    throw error_of(place_, errno);
  // Checked after the part was created: if the folder is replaced later, commit() does not find the part.
  try
  {
    require_in_place(place_);
  }
  catch (const OutputError &)
  {
    discard();
    throw;
  }
}

AtomicFile::~AtomicFile()
{
  if (descriptor_ >= 0)
    discard();
}

void AtomicFile::discard()
{
  ::close(descriptor_);
  ::unlink(part_.c_str());
}

void AtomicFile::write(std::string_view bytes)
{
  while (!bytes.empty())
  {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw error_of(place_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

std::string AtomicFile::name() const
{
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

void AtomicFile::commit(Sync sync)
{
  // Some file systems cannot sync (EINVAL); then the rename has to suffice.
  if (sync == Sync::yes && ::fsync(descriptor_) != 0 && errno != EINVAL)
    throw error_of(place_, errno);
  // Some file systems report a full disk or a broken connection only in close().
  int error_number = ::close(std::exchange(descriptor_, -1)) != 0 ? errno : 0;
  if (error_number == 0 && std::rename(part_.c_str(), place_.c_str()) != 0)
    error_number = errno;
  if (error_number != 0)
  {
    ::unlink(part_.c_str());
    throw error_of(place_, error_number);
  }
  if (sync == Sync::yes)
    sync_folder_of(place_);
}

void write_atomically(const fs::path &place, std::string_view text, Sync sync)
{
  AtomicFile file(place);
  file.write(text);
  file.commit(sync);
}

void create_folders(const fs::path &folder)
{
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw OutputError(folder, error.message());
}

std::size_t remove_stale_parts(const fs::path &folder, fs::file_time_type moment)
{
  std::size_t n_removed = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
  {
    std::error_code none;
    if (is_name_of_part(entry->path().filename().string()) &&
        entry->symlink_status(none).type() == fs::file_type::regular && entry->last_write_time(none) < moment && !none)
      n_removed += fs::remove(entry->path(), none) ? 1 : 0;
  }
  return n_removed;
}

} // namespace latcon::support
