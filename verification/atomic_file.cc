#include "verification/atomic_file.h"

#include "verification/errors.h"
#include "verification/output_list.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace verification
{

namespace
{

// The system's words for an error number; std::strerror is not safe with threads.
std::string reason(const int error_number)
{
  return std::generic_category().message(error_number);
}

// Writes all of the text and forces it to the disk. Returns the error number, 0 for none.
int write_and_sync(const int descriptor, const std::string &text)
{
  std::size_t written = 0;
  while (written < text.size())
  {
    const ssize_t n = ::write(descriptor, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return errno;
    written += static_cast<std::size_t>(n);
  }
  // Not every file system can sync (EINVAL); there the rename is all that can be had.
  if (::fsync(descriptor) != 0 && errno != EINVAL)
    return errno;
  return 0;
}

} // namespace

void write_file(const std::string &path, const std::string &text)
{
  list_output(path);
  replace_file(path, text);
}

void replace_file(const std::string &path, const std::string &text)
{
  // Renaming over a device or a folder would destroy it or fail late.
  struct stat status
  {
  };
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw OutputError(path, S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file");

  const std::string part = path + ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0)
    throw OutputError(path, reason(errno));

  int error_number = write_and_sync(descriptor, text);
  // Some file systems tell of a full disk or a broken connection only here.
  if (::close(descriptor) != 0 && error_number == 0)
    error_number = errno;
  if (error_number == 0 && std::rename(part.c_str(), path.c_str()) != 0)
    error_number = errno;
  if (error_number != 0)
  {
    ::unlink(part.c_str());
    throw OutputError(path, reason(error_number));
  }

  // The new name is in the folder, which has to reach the disk as well. The file is whole either way, so a folder that
  // cannot be synced is no failure.
  std::string folder = std::filesystem::path(path).parent_path().string();
  const int folder_descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_descriptor >= 0)
  {
    ::fsync(folder_descriptor);
    ::close(folder_descriptor);
  }
}

void write_file(const std::string &path, const std::function<void(std::ostream &)> &writer)
{
  std::ostringstream text;
  writer(text);
  if (!text)
    throw OutputError(path, "its content could not be formatted");
  write_file(path, text.str());
}

std::string full_precision(const double value)
{
  if (std::isnan(value))
    return "nan";
  std::array<char, 32> digits{};
  const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  (void)status; // 24 characters are the longest there are
  return std::string(digits.data(), end);
}

} // namespace verification
