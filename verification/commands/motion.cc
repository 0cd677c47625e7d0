#include "verification/commands/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <omp.h>

#include "verification/commands/signals.h"
#include "verification/output/progress.h"

namespace latcon::commands
{

Motion::Motion(const input::Case &input, output::Checkpoints &checkpoints, Run &run, double time_step,
               std::size_t signal_interval)
  : input_(input), run_(run), checkpoints_(checkpoints), time_step_(time_step), signal_interval_(signal_interval),
    n_steps_(static_cast<std::size_t>(std::ceil(input.end_time / time_step * (1. - 1e-12)))),
    next_frame_(input.frame_interval)
{
}

std::pair<std::string, double> Motion::progress() const
{
  return {"/" + std::to_string(n_steps_), static_cast<double>(step_) / static_cast<double>(n_steps_)};
}

// Checks the state of the motion in a checkpoint before it is used. @throws std::invalid_argument
void Motion::check_loaded()
{
  step_ = checkpoints_.found()->step;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double done = static_cast<double>(step_), frames = static_cast<double>(n_frames());
  support::require(time() == checkpoints_.found()->time, "`time` differs from that in `run`");
  // Steps may have been added up one by one.
  support::require(std::abs(time() - done * time_step_) <= std::max(4., done) * epsilon * time(),
                   "`time` does not match the number of steps");
  support::require(done == 0. || time() <= input_.end_time + time() / done, "`time` is after the end");
  // One frame at the start and one per interval, but at most one per step.
  if (input_.frame_interval > 0.)
    support::require(frames >= 1. && frames <= done + 1. &&
                       std::abs(next_frame_ - frames * input_.frame_interval) <= frames * epsilon * next_frame_,
                     "`next_frame` does not follow the frames that there are");
}

void Motion::go(const std::string &phase_name)
{
  const auto parts = [this](auto &archive)
  {
    this->archive(archive);
    archive("next_frame", next_frame_);
    if constexpr (std::decay_t<decltype(archive)>::loads)
      check_loaded();
  };
  const bool resumed = checkpoints_.resume(parts);
  if (!resumed)
    start();
  const SignalDeferral deferral;
  if (resumed)
    write_resumed();
  else
    write();
  output::Progress shown(run_.is_verbose(), progress().second);
  try
  {
    const auto phase = run_.info().stopwatch().phase(phase_name);
    while (!is_complete())
    {
      if (step_ % signal_interval_ == 0)
      {
        const bool is_stopped = any_rank_interrupted();
        if (is_stopped || checkpoints_.due(step_))
          checkpoints_.write(step_, time(), parts);
        if (is_stopped)
          break;
      }
      advance();
      ++step_;
      if (step_ % input_.energy_interval == 0)
        record_energies();
      if (input_.frame_interval > 0. && time() >= next_frame_)
      {
        write(); // all results so far are on disk from here on
        next_frame_ += input_.frame_interval;
      }
      if (shown.due())
      {
        const auto [text, done] = progress();
        shown.show("step " + std::to_string(step_) + text, done);
      }
    }
    record_energies();
  }
  catch (const support::SolverError &failure)
  {
    std::string message = failure.what();
    try
    {
      write_failed();
      flush();
    }
    catch (const std::exception &other) // the cause is the message that matters
    {
      message += std::string("\nthe state before it could not be written: ") + other.what();
    }
    MPI_Barrier(MPI_COMM_WORLD); // the exception of another rank would end the one that writes
    throw support::SolverError(message);
  }
  write();
  flush();
}

output::Result ledger_row(const std::string &claim, const claims::Sides &sides, double imbalance,
                          const output::Tolerance &allowed)
{
  const std::string quantity = "energy imbalance over energy exchanged";
  return {claim, quantity, "1", sides.lattice, sides.continuum, {}, imbalance, allowed, false, output::RowKind::ledger};
}

LatticeMotion::LatticeMotion(const input::Case &input, lattice::Simulation &simulation,
                             output::Checkpoints &checkpoints, Run &run)
  : Motion(input, checkpoints, run, simulation.time_step(), steps_between_signals), simulation_(simulation),
    record_(simulation, input.time_step ? "Time/step" : "Time/safety factor"),
    threads_(run.has_default_threads() ? omp_get_max_threads() : 1),
    frames_(std::make_shared<output::FieldWriter>(simulation.lattice(), simulation.material(), run.directory()))
{
}

void LatticeMotion::advance()
{
  writing_.check();
  threads_.begin_step(writing_.is_busy() ? 1 : 0);
  after_step(simulation_.step());
}

output::TextFiles LatticeMotion::tables() const
{
  return run_.is_root() ? record_.tables(run_.directory()) : output::TextFiles{};
}

void LatticeMotion::write()
{
  const lattice::State &whole = simulation_.gather();
  if (run_.is_root())
    writing_.add(
      [frames = frames_, state = std::make_shared<const lattice::State>(whole), files = tables()]
      {
        frames->add_frame(*state);
        output::write_files(files);
      });
}

void LatticeMotion::write_resumed()
{
  output::write_files(tables());
  if (run_.is_root())
    frames_->write_collection();
}

void LatticeMotion::archive(output::CheckpointWriter &archive)
{
  record_.check();
  flush();
  parts(archive);
}

} // namespace latcon::commands
