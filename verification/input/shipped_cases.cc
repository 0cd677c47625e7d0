#include "verification/input/shipped_cases.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "verification/input/case_text.h"
#include "verification/input/data_folder.h"
#include "verification/input/spelling.h"

namespace latcon::input
{

std::vector<std::string> shipped_cases()
{
  std::vector<std::string> names;
  std::error_code none;
  for (const auto &file : std::filesystem::directory_iterator(data_folder() + "/cases", none))
    if (file.path().extension() == ".prm")
      names.push_back(file.path().stem());
  std::sort(names.begin(), names.end());
  return names;
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
  const bool is_file = std::filesystem::exists(name, none) && !std::filesystem::is_directory(name, none);
  return is_shipped && !is_file ? shipped_case_file(name) : name;
}

std::string shipped_case_hint(const std::string &path)
{
  const std::vector<std::string> names = shipped_cases();
  const std::string nearest = nearest_word(std::filesystem::path(path).stem(), names);
  if (!nearest.empty())
    return "; nearest shipped case: " + nearest;
  return names.empty() ? "" : "; shipped cases: " + comma_separated(names);
}

} // namespace latcon::input
