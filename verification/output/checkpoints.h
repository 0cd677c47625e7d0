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

/// Where a run was when it left a checkpoint.
struct CheckpointPlace
{
  std::filesystem::path file;
  std::size_t step = 0;     ///< steps done
  double time = 0.;         ///< of the sheet [s]
  std::string commit;       ///< of the program that wrote it, see git_commit()
  std::string program_hash; ///< of the program that wrote it, see program_hash()
};

/// A checkpoint whose bytes are those that were written, but whose contents are none that this run can have left.
class UnusableCheckpoint : public support::InputError
{
public:
  using support::InputError::InputError;
};

/// Refuses steps done and a time [s] that are not those of the checkpoint, or do not belong together: the time is to be
/// `expected` within `rounding`. @throws std::invalid_argument
void require_course(const CheckpointPlace &place, std::size_t step, double time, double expected, double rounding);

/// The checkpoints of a run, in the folder `checkpoints` of its output directory: HDF5 files checkpoint-STEP.h5, of
/// which the last two are kept.
///
/// A file begins with a line that holds the SHA-256 of all behind its first 512 bytes, where the HDF5 part begins. The
/// group `run` in it tells the schema, the program, the command, the case (all entries but those about checkpoints,
/// with a hash), step and time; the rest is what the parts of the run archived, under the names they gave it. A run
/// goes on from the file with the most steps that is whole and belongs to it, whatever the files are called.
class Checkpoints
{
public:
  /// Looks for a checkpoint to go on from, if the options ask for that. To be made before anything is written.
  /// Collective. @param command name of the command @throws InputError if there are checkpoints and none can be used:
  /// each with the reason
  Checkpoints(const input::Options &options, const input::Parameters &parameters, const input::Case &input,
              std::string command);

  /// The checkpoint that the run goes on from; none where it starts from the beginning.
  const std::optional<CheckpointPlace> &found() const { return found_; }

  /// Loads the parts of a run, set up as for its first step, from the checkpoint that was found; where there is none,
  /// does nothing but move checkpoints of an earlier run out of the way, to `checkpoints.old`. Collective.
  /// @param parts called with an archive
  /// @return whether there was one. @throws UnusableCheckpoint if parts do not fit it, OutputError
  template <class Parts>
  bool resume(const Parts &parts)
  {
    if (!found_)
    {
      archive_stale_checkpoints();
      return false;
    }
    load([&](CheckpointReader &archive) { parts(archive); });
    return true;
  }

  /// Whether a checkpoint is to be written now: by steps, or by the wall time since the last. To be called after every
  /// `steps_between_signals` steps at most. Collective, with the same answer on all ranks.
  bool due(std::size_t step);

  /// Writes a checkpoint, and deletes those before the last two. Collective; the first rank writes.
  /// @param parts called with an archive @throws OutputError
  template <class Parts>
  void write(std::size_t step, double time, const Parts &parts)
  {
    save(step, time, [&](CheckpointWriter &archive) { parts(archive); });
  }

private:
  void find(const input::Parameters &parameters);
  std::string problem_of(const std::filesystem::path &path, CheckpointPlace &place) const;
  void load(const std::function<void(CheckpointReader &)> &parts) const;
  void save(std::size_t step, double time, const std::function<void(CheckpointWriter &)> &parts);
  void archive_stale_checkpoints() const;
  std::vector<std::filesystem::path> files() const;

  std::filesystem::path folder_;
  std::string command_;
  std::string case_text_; // an entry a line
  std::string case_hash_;
  std::size_t step_interval_;
  double wall_interval_; // [s]
  bool first_rank_;
  std::optional<CheckpointPlace> found_;
  std::chrono::steady_clock::time_point last_written_ = std::chrono::steady_clock::now();
  std::size_t last_step_asked_ = 0;
};

} // namespace latcon::output
