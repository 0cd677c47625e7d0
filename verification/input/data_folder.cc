#include "verification/input/data_folder.h"

#include <filesystem>

namespace latcon::input
{

std::string data_folder()
{
  namespace fs = std::filesystem;
  std::error_code status;
  const fs::path program = fs::read_symlink("/proc/self/exe", status);
  for (fs::path above = program.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (const fs::path folder = above / "share" / "latcon"; fs::is_directory(folder, status))
      return fs::canonical(folder, status);
  return program.parent_path().parent_path() / "share" / "latcon";
}

} // namespace latcon::input
