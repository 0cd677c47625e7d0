#include "verification/commands/requested_study.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include "support/atomic_file.h"
#include "support/errors.h"
#include "verification/input/case_text.h"
#include "verification/input/shipped_cases.h"
#include "verification/study/shard.h"
#include "verification/study/sweep.h"

namespace latcon::commands
{
namespace
{

namespace fs = std::filesystem;

constexpr const char *another_folder = "; choose another folder (--output-dir)";

// Refuses to replace a file that the user may have edited.
void require_same_or_absent(const std::string &file, const std::string &text, const std::string &other)
{
  std::error_code none;
  if (fs::exists(file, none) && input::read_input_file(file).text != text)
    throw support::InputError(file + " differs from " + other + "; to run the stored sweep: latcon study " +
                              (fs::path(file).parent_path() / study::sweep_file_name).string() +
                              "; for another one choose another --output-dir");
}

RequestedStudy read_sweep(const input::Options &options, const std::string &name, const SweepOptions &chosen)
{
  RequestedStudy requested;
  const std::string case_file = input::case_path(name);
  requested.base = input::read_input_file(case_file);
  if (!requested.base.problem.empty())
    throw support::InputError(input::printable(case_file) + ": cannot read the case of --sweep: " +
                              requested.base.problem + input::shipped_case_hint(case_file));
  const fs::path folder = options.output_dir;
  const std::string base = fs::path(case_file).extension() == ".json" ? "base.json" : "base.prm";
  requested.file = (folder / study::sweep_file_name).string();
  requested.base_file = (folder / base).string();
  requested.sweep_text = study::sweep_study(chosen.sweeps, fs::path(case_file).stem().string(), base,
                                            study::parse_settings(options.overrides), chosen.seeds);
  requested.study = study::read_study(requested.sweep_text, requested.file, options.quick);
  requested.study.base = case_file; // for messages
  require_same_or_absent(requested.file, requested.sweep_text, "this sweep");
  require_same_or_absent(requested.base_file, requested.base.text, case_file);
  return requested;
}

} // namespace

RequestedStudy read_requested_study(const input::Options &options, const std::string &study, const SweepOptions &sweep)
{
  if (!sweep.sweeps.empty())
    return read_sweep(options, study, sweep);
  if (sweep.seeds > 0)
    throw support::InputError("--seeds is an option of --sweep; a study file lists its seeds");
  RequestedStudy requested;
  requested.file = study::study_path(study);
  requested.study = study::read_study_file(requested.file, options.quick);
  requested.base = input::read_input_file(requested.study.base);
  requested.settings = options.overrides;
  return requested;
}

study::Verification verification_of(const input::Options &options)
{
  if (options.skip_verification)
    return study::Verification::none;
  return options.quick ? study::Verification::base_case : study::Verification::every_run;
}

void write_sweep(const RequestedStudy &requested)
{
  if (!requested.is_sweep())
    return;
  const auto write = [](const std::string &file, const std::string &text)
  {
    if (!fs::exists(file))
      support::write_atomically(file, text, support::Sync::yes);
  };
  write(requested.base_file, requested.base.text);
  write(requested.file, requested.sweep_text);
}

void require_no_refinement(const study::Study &study)
{
  if (study.refine > 0)
    throw support::InputError(study.file + ": refine = " + std::to_string(study.refine) +
                              ": a refined study does not run in shards, because its points depend on the patterns of "
                              "others; allowed: 0, or latcon study without --shard and --collect");
}

void require_folder_of(const study::Study &study, const std::string &directory)
{
  for (const auto &[file, key] :
       {std::pair{"study.json", "title"}, std::pair{"run.json", "study"}, std::pair{study::plan_file_name, "study"}})
  {
    const auto document =
      nlohmann::json::parse(input::read_input_file((fs::path(directory) / file).string()).text, nullptr, false);
    if (document.is_object() && document.contains(key) && document[key].is_string() && document[key] != study.title)
      throw support::InputError(directory + " has the results of another study, '" +
                                input::printable(document[key].get<std::string>()) + "'" + another_folder);
  }
}

} // namespace latcon::commands
