#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lattice/simulation.h"
#include "support/dynamic_threads.h"
#include "support/task_thread.h"
#include "verification/commands/command.h"
#include "verification/output/checkpoints.h"
#include "verification/output/crack_record.h"
#include "verification/output/field_writer.h"

namespace latcon::commands
{

/// Motion of a sheet with its output between steps, whichever side moves: frames, tables, checkpoints, signals,
/// progress. On every rank alike. All that was recorded is on disk when a checkpoint is written and when go() returns.
class Motion
{
public:
  virtual ~Motion() = default;

  /// Moves the sheet from its first step, or from the checkpoint found, until it is complete or a signal comes. Then,
  /// and if a step fails, writes the last frame and the tables. @param phase name of its time in run.json
  /// @throws SolverError if a step fails, OutputError
  void go(const std::string &phase);

protected:
  /// @param time_step [s] @param signal_interval number of steps between two polls of signals
  Motion(const input::Case &input, output::Checkpoints &checkpoints, Run &run, double time_step,
         std::size_t signal_interval = 1);

  virtual double time() const = 0;                               ///< [s]
  virtual bool is_complete() const { return step_ >= n_steps_; } ///< true if there is no further step
  virtual std::size_t n_frames() const = 0;                      ///< written so far
  virtual std::pair<std::string, double> progress() const;       ///< text, and the completed fraction
  virtual void start() = 0;                   ///< sets and records the state before the first step
  virtual void advance() = 0;                 ///< makes and records a step; throws SolverError on all ranks
  virtual void record_energies() = 0;
  virtual void write() = 0;                   ///< current state as a frame, and the tables
  virtual void write_failed() { write(); }    ///< last valid state, after a step that failed
  virtual void flush() {}                     ///< returns when all is on disk
  virtual void write_resumed() = 0;           ///< tables and lists of frames, without what followed the checkpoint
  virtual void archive(output::CheckpointReader &archive) = 0;
  virtual void archive(output::CheckpointWriter &archive) = 0;

  const input::Case &input_;
  Run &run_;

private:
  void check_loaded();

  output::Checkpoints &checkpoints_;
  double time_step_;                       // [s]
  std::size_t signal_interval_, step_ = 0; // steps done
  std::size_t n_steps_;                    // until the end time
  double next_frame_;                      // [s]
};

/// Returns the row about the energies of a run. @param sides with the imbalance @param imbalance
/// output::LedgerCheck::imbalance() [-] @param allowed with which it holds
output::Result ledger_row(const std::string &claim, const claims::Sides &sides, double imbalance,
                          const output::Tolerance &allowed);

/// Motion of the lattice. The root rank writes frames and tables on a thread of its own, while the sheet moves on. A
/// default number of threads is adjusted to the load of the machine.
class LatticeMotion : public Motion
{
public:
  /// @param simulation at its first step; must outlive the motion
  LatticeMotion(const input::Case &input, lattice::Simulation &simulation, output::Checkpoints &checkpoints, Run &run);

  output::CrackRecord &record() { return record_; }

protected:
  double time() const override { return simulation_.state().time; }
  std::size_t n_frames() const override { return frames_->times().size(); }
  void start() override { record_.start(); }
  void advance() override;
  void record_energies() override { record_.energies(); }
  void write() override;
  void flush() override { writing_.wait(); }
  void write_resumed() override;
  void archive(output::CheckpointReader &archive) override { parts(archive); }
  void archive(output::CheckpointWriter &archive) override;
  virtual void after_step(const std::vector<lattice::BrokenBond> &) {} ///< given the bonds that broke in it

  lattice::Simulation &simulation_;
  output::CrackRecord record_;
  support::TaskThread writing_;

private:
  output::TextFiles tables() const;
  template <class Archive>
  void parts(Archive &archive)
  {
    archive("simulation", simulation_);
    archive("record", record_);
    archive("frames", *frames_);
  }

  support::DynamicThreads threads_;
  std::shared_ptr<output::FieldWriter> frames_; // also of the tasks that are pending
};

} // namespace latcon::commands
