#include "verification/commands/lattice_motion.h"

#include <cmath>
#include <limits>

#include "verification/commands/signals.h"
#include "verification/output/progress.h"

namespace latcon::commands
{

LatticeMotion::LatticeMotion(const input::Case &input, lattice::Simulation &simulation,
                             output::Checkpoints &checkpoints, Run &run)
  : input_(input), simulation_(simulation), checkpoints_(checkpoints), run_(run),
    record_(simulation, input.time_step ? "Time/step" : "Time/safety factor"),
    frames_(std::make_shared<output::FieldWriter>(simulation.lattice(), simulation.material(), run.directory())),
    next_frame_(input.frame_interval)
{
}

void LatticeMotion::add_frame(output::TextFiles tables)
{
  const lattice::State &whole = simulation_.gather();
  if (run_.is_root())
    writing_.add(
      [frames = frames_, state = std::make_shared<const lattice::State>(whole), files = std::move(tables)]
      {
        frames->add_frame(*state);
        output::write_files(files);
      });
}

output::TextFiles LatticeMotion::tables() const
{
  return run_.is_root() ? record_.tables(run_.directory()) : output::TextFiles{};
}

// Checks the state of the motion in a checkpoint before it is used. @throws std::invalid_argument
void LatticeMotion::check_loaded()
{
  const double time = simulation_.state().time, step = simulation_.time_step(), done = static_cast<double>(step_);
  // Steps were added up one by one.
  output::require_matching_time(*checkpoints_.found(), step_, time, done * step,
                                done * std::numeric_limits<double>::epsilon() * time);
  lattice::require_archived(time <= input_.end_time + step, "`time` is after the end");
  // One frame at the start and one per interval, but at most one per step.
  if (run_.is_root() && input_.frame_interval > 0.)
  {
    const double frames = static_cast<double>(frames_->n_frames());
    lattice::require_archived(frames >= 1. && frames <= done + 1. &&
                                std::abs(next_frame_ - frames * input_.frame_interval) <=
                                  frames * std::numeric_limits<double>::epsilon() * next_frame_,
                              "`next_frame` does not follow the frames that there are");
  }
}

void LatticeMotion::go(const StepCallbacks &callbacks, bool resumed, const std::function<void()> &write_checkpoint)
{
  const SignalDeferral deferral;
  if (resumed)
  {
    // Removes what was written after the checkpoint.
    output::write_files(tables());
    if (run_.is_root())
      frames_->write_collection();
  }
  else
  {
    record_.start();
    add_frame();
  }
  if (callbacks.begin)
    callbacks.begin(resumed);
  output::Progress progress(run_.is_verbose());
  try
  {
    const auto phase = run_.info().stopwatch().phase(callbacks.phase);
    while (callbacks.goes_on())
    {
      if (step_ % steps_between_signals == 0)
      {
        if (any_rank_interrupted())
        {
          write_checkpoint();
          break;
        }
        if (checkpoints_.due(step_))
          write_checkpoint();
        writing_.check();
      }
      ++step_;
      callbacks.after_step(simulation_.step());
      if (step_ % input_.energy_interval == 0)
        record_.energies();
      if (input_.frame_interval > 0. && simulation_.state().time >= next_frame_)
      {
        // All results so far are on disk from here on.
        add_frame(tables());
        next_frame_ += input_.frame_interval;
      }
      if (progress.due())
      {
        const auto [text, done] = callbacks.progress();
        progress.show("step " + std::to_string(step_) + text, done);
      }
    }
    record_.energies();
    run_.info().add("divided_steps", static_cast<std::uint64_t>(simulation_.n_divided_steps()));
  }
  catch (const support::SolverError &)
  {
    // The last valid state, and the records until then.
    add_frame(tables());
    writing_.wait();
    throw;
  }
  add_frame(tables());
  writing_.wait();
}

} // namespace latcon::commands
