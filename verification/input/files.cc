#include "verification/input/files.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "verification/input/case_text.h"

namespace latcon::input
{
namespace fs = std::filesystem;

namespace
{

// Names of the files with an ending in a data folder, sorted.
std::vector<std::string> names_in(const std::string &folder, const std::string &ending)
{
  std::vector<std::string> names;
  std::error_code none;
  for (const auto &file : fs::directory_iterator(data_folder() + "/" + folder, none))
    if (file.path().extension() == ending)
      names.push_back(file.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

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

InputFile read_input_file(const std::string &path)
{
  constexpr std::size_t largest = std::size_t(16) << 20;
  std::error_code status;
  if (fs::is_directory(path, status))
    return {"", "it is a folder"};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return {"", std::generic_category().message(errno)};
  InputFile input;
  while (file && input.text.size() <= largest) // most files are small
  {
    constexpr std::streamsize block = 1 << 16;
    const std::size_t before = input.text.size();
    input.text.resize(before + block);
    file.read(&input.text[before], block);
    input.text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    input.problem = std::generic_category().message(errno);
  else if (input.text.size() > largest)
    input.problem = "it is larger than 16 MiB";
  return input;
}

std::vector<std::string> shipped_cases()
{
  return names_in("cases", ".prm");
}

std::vector<std::string> shipped_studies()
{
  return names_in("studies", ".json");
}

std::string shipped_case_file(const std::string &name)
{
  return data_folder() + "/cases/" + name + ".prm";
}

std::string case_path(const std::string &name)
{
  const std::vector<std::string> names = shipped_cases();
  std::error_code none;
  const bool is_shipped = std::find(names.begin(), names.end(), name) != names.end();
  // A folder of this name, such as the output directory of the case, is no case.
  const bool is_file = fs::exists(name, none) && !fs::is_directory(name, none);
  return is_shipped && !is_file ? shipped_case_file(name) : name;
}

std::string shipped_case_hint(const std::string &path)
{
  const std::vector<std::string> names = shipped_cases();
  const std::string nearest = nearest_word(fs::path(path).stem(), names);
  if (!nearest.empty())
    return "; nearest shipped case: " + nearest;
  return names.empty() ? "; the folder of shipped cases is missing: " + data_folder()
                       : "; shipped cases: " + comma_separated(names);
}

} // namespace latcon::input
