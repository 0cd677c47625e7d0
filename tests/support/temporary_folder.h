/// Temporary folder of a test, removed with its content on destruction.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    // mkdtemp replaces the last six letters, which must be X.
    std::string name = (std::filesystem::temp_directory_path() / "latcon_test_").string() + std::string(6, 'X');
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("no temporary folder");
    path_ = name;
  }

  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;

  /// Returns the full path of a file in the folder.
  [[nodiscard]] std::string operator/(const std::string &name) const { return (path_ / name).string(); }
  /// Writes a file, in a folder of its own if the name has one.
  void write(const std::string &name, const std::string &text) const
  {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  [[nodiscard]] std::string path() const { return path_.string(); }

private:
  std::filesystem::path path_;
};

/// Returns the content of a file.
inline std::string content_of(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
