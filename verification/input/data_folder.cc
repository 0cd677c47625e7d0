#include "verification/input/data_folder.h"

#include <filesystem>

namespace latcon::input
{
namespace fs = std::filesystem;

std::string data_folder()
{
  std::error_code status;
  const fs::path program = fs::read_symlink("/proc/self/exe", status);
  for (fs::path above = program.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (const fs::path folder = above / "share" / "latcon"; fs::is_directory(folder, status))
      return fs::canonical(folder, status);
  return program.parent_path().parent_path() / "share" / "latcon";
}

std::string module_file()
{
  std::error_code status;
  const fs::path folder = fs::read_symlink("/proc/self/exe", status).parent_path();
  for (const fs::path &file : {folder / module_name, folder.parent_path() / "lib" / "latcon" / module_name})
    if (fs::exists(file, status))
      return fs::canonical(file, status);
  return "";
}

} // namespace latcon::input
