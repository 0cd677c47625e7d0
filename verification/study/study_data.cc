// Parts of a study that do not depend on how its file is read.
#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/input/data_folder.h"
#include "verification/study/quantities.h"
#include "verification/study/study_file.h"

namespace latcon::study
{

void override_settings(Settings &settings, const Settings &others)
{
  for (const auto &[key, value] : others)
  {
    const auto same = [&key = key](const auto &setting) { return setting.first == key; };
    const auto found = std::find_if(settings.begin(), settings.end(), same);
    if (found == settings.end())
      settings.emplace_back(key, value);
    else
      found->second = value;
  }
}

std::string StudyRow::unit() const
{
  return quantity == pattern_quantity ? "1" : unit_of(quantity);
}

const StudyRun &Study::run(const std::string &name) const
{
  const auto found = std::find_if(runs.begin(), runs.end(), [&name](const StudyRun &run) { return run.name == name; });
  if (found == runs.end())
    throw std::logic_error("study: '" + name + "' is not a run");
  return *found;
}

std::string entry_unit(const std::string &key)
{
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  return parameters.unit(key);
}

std::vector<std::string> shipped_studies()
{
  std::vector<std::string> names;
  std::error_code status;
  for (const auto &file : std::filesystem::directory_iterator(input::data_folder() + "/studies", status))
    if (file.path().extension() == ".json")
      names.push_back(file.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

std::string study_choices()
{
  const std::vector<std::string> names = shipped_studies();
  return "study file (.json)" +
         (names.empty() ? std::string() : ", or a shipped one: " + input::comma_separated(names));
}

std::string study_path(const std::string &name)
{
  const std::vector<std::string> names = shipped_studies();
  const bool is_shipped = std::find(names.begin(), names.end(), name) != names.end();
  return is_shipped && !std::filesystem::exists(name) ? input::data_folder() + "/studies/" + name + ".json" : name;
}

} // namespace latcon::study
