/// Study that a user asks for: a file, a shipped one, or a sweep on the command line.
#pragma once

#include <string>
#include <vector>

#include "verification/commands/command.h"
#include "verification/input/input_file.h"
#include "verification/study/study_plan.h"

namespace latcon::commands
{

/// Study with its base case, read but not planned. A sweep has not been written yet.
struct RequestedStudy
{
  study::Study study;
  input::InputFile base;
  std::vector<std::string> settings; ///< of --set; none for a sweep, whose study file contains them
  std::string file;                  ///< study file; of a sweep the one that write_sweep() writes
  std::string sweep_text;            ///< of that file; empty unless this is a sweep
  std::string base_file;             ///< copy of the case beside it

  bool is_sweep() const { return !sweep_text.empty(); }
};

/// Reads the study, or the case of a sweep. @param options with the output directory of the study
/// @throws InputError also if the output directory has the files of another sweep
[[nodiscard]] RequestedStudy read_requested_study(const input::Options &options, const std::string &study,
                                                  const SweepOptions &sweep);

/// Cases whose claims the study checks, as chosen by --quick and --skip-verification.
[[nodiscard]] study::Verification verification_of(const input::Options &options);

/// Writes the study file of a sweep and the copy of its case into the existing output directory, unless they exist.
/// Later runs do not archive them. The directory must be locked by this process. No effect for other studies.
/// @throws OutputError
void write_sweep(const RequestedStudy &requested);

/// Refuses an output directory with the results of another study. @throws InputError
void require_folder_of(const study::Study &study, const std::string &directory);

/// Refuses a study whose runs depend on the outcomes of others, and that cannot run in shards therefore.
/// @throws InputError
void require_no_refinement(const study::Study &study);

} // namespace latcon::commands
