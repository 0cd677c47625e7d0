#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lattice/simulation.h"
#include "support/task_thread.h"
#include "verification/commands/command.h"
#include "verification/output/checkpoints.h"
#include "verification/output/crack_record.h"
#include "verification/output/field_writer.h"

namespace latcon::commands
{

/// Output of a moving lattice between steps, with or without a crack: frames, tables, the energy ledger, checkpoints,
/// signals, progress. On every rank alike; the root rank writes frames and tables on a thread of its own, while the
/// sheet moves on. All that was added is on disk when a checkpoint is written and when go() returns.
class LatticeMotion
{
public:
  /// @param simulation at its first step; must outlive the motion
  LatticeMotion(const input::Case &input, lattice::Simulation &simulation, output::Checkpoints &checkpoints, Run &run);

  /// Functions that a motion calls at each step.
  struct StepCallbacks
  {
    std::string phase;                                                        ///< name of its time in run.json
    std::function<bool()> goes_on;                                            ///< whether there is a further step
    std::function<void(const std::vector<lattice::BrokenBond> &)> after_step; ///< given the bonds that broke in it
    std::function<std::pair<std::string, double>()> progress;                 ///< text, and the completed fraction
    std::function<void(bool resumed)> begin = {};                             ///< before the first step, if given
  };

  /// Moves the sheet from its first step, or from the checkpoint found, until `goes_on` is false or a signal comes.
  /// Then, and if it blows up, writes the last frame and the tables.
  /// @param extra_state archives further state of the motion, given an archive
  /// @throws SolverError if the sheet blows up, OutputError
  template <class ExtraState>
  void go(const StepCallbacks &callbacks, const ExtraState &extra_state)
  {
    const auto parts = [&](auto &archive)
    {
      archive("simulation", simulation_);
      archive("record", record_);
      extra_state(archive);
      archive("frames", *frames_);
      archive("next_frame", next_frame_);
      archive("step", step_);
      if constexpr (std::decay_t<decltype(archive)>::loads)
        check_loaded();
    };
    const bool resumed = checkpoints_.resume(parts);
    go(callbacks, resumed,
       [&]
       {
         record_.check();
         writing_.wait();
         checkpoints_.write(step_, simulation_.state().time, parts);
       });
  }

  output::CrackRecord &record() { return record_; }
  support::TaskThread &writing() { return writing_; } ///< thread that writes frames and tables
  std::size_t step() const { return step_; }          ///< steps done

private:
  void check_loaded();
  void go(const StepCallbacks &callbacks, bool resumed, const std::function<void()> &write_checkpoint);
  void add_frame(output::TextFiles tables = {});
  output::TextFiles tables() const;

  const input::Case &input_;
  lattice::Simulation &simulation_;
  output::Checkpoints &checkpoints_;
  Run &run_;
  output::CrackRecord record_;
  std::shared_ptr<output::FieldWriter> frames_; // also of the tasks that are pending
  double next_frame_;                           // [s]
  std::size_t step_ = 0;
  support::TaskThread writing_;
};

} // namespace latcon::commands
