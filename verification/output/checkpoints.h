#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "support/errors.h"
#include "verification/output/archive.h"

namespace latcon::input
{
struct Case;
struct Options;
class Parameters;
} // namespace latcon::input

namespace latcon::output
{

/// State of progress of a run at a checkpoint.
struct CheckpointPlace
{
  std::filesystem::path file;
  std::size_t step = 0;     ///< steps done
  double time = 0.;         ///< simulated time [s]
  std::string commit;       ///< of the program that wrote it, see git_commit()
  std::string program_hash; ///< of the program that wrote it, see program_hash()
};

/// Checkpoint that is intact but cannot have been written by this run.
class UnusableCheckpoint : public support::InputError
{
public:
  using support::InputError::InputError;
};

/// Checkpoints of a run: HDF5 files checkpoint-STEP.h5 in the folder `checkpoints` of its output directory, of which
/// the last two are kept.
///
/// A file begins with a line that contains the SHA-256 of all bytes after the first 512; the HDF5 part begins there.
/// Its group `run` contains the schema, the program, the command, the case (all entries except those about checkpoints,
/// with a hash), step and time; the other groups contain the archives of the parts of the run. A run resumes from the
/// file with the most steps that is intact and belongs to it, regardless of file names.
class Checkpoints
{
public:
  /// Searches for a checkpoint to resume from, if the options request it. To be created before the run writes anything.
  /// Collective. @param command name of the command @throws InputError if there are checkpoints but none can be used,
  /// with the reason for each
  Checkpoints(const input::Options &options, const input::Parameters &parameters, const input::Case &input,
              std::string command);

  /// Returns the checkpoint from which the run resumes; none if it starts from the beginning.
  const std::optional<CheckpointPlace> &found() const { return found_; }

  /// Loads the parts of a run, which must be set up as for its first step, from the checkpoint that was found, if any.
  /// Collective. @return true if there was one. @throws UnusableCheckpoint if the parts do not match it
  bool resume(const std::function<void(CheckpointReader &)> &parts) const;

  /// Returns true if a checkpoint is due, by the number of steps or by the wall time since the last one. To be called
  /// at least every `steps_between_signals` steps. Collective, with the same result on all ranks.
  bool due(std::size_t step);

  /// Writes a checkpoint, and deletes all but the last two. Collective; the root rank writes.
  /// @throws OutputError
  void write(std::size_t step, double time, const std::function<void(CheckpointWriter &)> &parts);

private:
  std::string problem_of(const std::filesystem::path &path, CheckpointPlace &place) const;
  std::vector<std::filesystem::path> files() const;

  std::filesystem::path folder_;
  std::string command_;
  std::string case_text_; // one entry per line
  std::string case_hash_;
  std::size_t step_interval_;
  double wall_interval_; // [s]
  bool first_rank_;
  std::optional<CheckpointPlace> found_;
  std::chrono::steady_clock::time_point last_written_ = std::chrono::steady_clock::now();
  std::size_t last_step_asked_ = 0;
};

} // namespace latcon::output
