/// Exceptions of file access.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace latcon::support
{

/// A file could not be written; the old one is untouched.
class WriteError : public std::runtime_error
{
public:
  /// @param place the file that was to be written @param reason why it was not, usually the system's own words
  WriteError(const std::filesystem::path &place, const std::string &reason)
    : std::runtime_error("cannot write " + place.string() + ": " + reason), reason_(reason)
  {
  }

  [[nodiscard]] const std::string &reason() const noexcept { return reason_; }

private:
  std::string reason_;
};

/// Another process writes to the folder.
class FolderInUse : public std::runtime_error
{
public:
  /// @param owner process and machine, as the lock file names them; empty: not known
  FolderInUse(const std::filesystem::path &folder, const std::string &owner);
};

} // namespace latcon::support
