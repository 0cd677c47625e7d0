#include "verification/commands/lattice_motion.h"

#include "verification/commands/signals.h"
#include "verification/progress.h"

namespace verification
{

LatticeMotion::LatticeMotion(const Case &input, lattice::Simulation &simulation, Checkpoints &checkpoints, Run &run)
  : input_(input), simulation_(simulation), checkpoints_(checkpoints), run_(run), record_(simulation),
    frames_(simulation.lattice(), simulation.material(), run.directory()), next_frame_(input.frame_interval)
{
}

void LatticeMotion::add_frame()
{
  const lattice::State &whole = simulation_.gather();
  if (run_.writes())
    frames_.add_frame(whole);
}

void LatticeMotion::write_tables() const
{
  if (run_.writes())
    record_.write_tables(run_.directory());
}

void LatticeMotion::go(const Course &course, bool resumed, const std::function<void()> &write_checkpoint)
{
  const SignalDeferral deferral;
  if (resumed)
  {
    // What was written after the checkpoint goes.
    write_tables();
    if (run_.writes())
      frames_.write_collection();
  }
  else
  {
    record_.start();
    add_frame();
  }
  if (course.begin)
    course.begin(resumed);
  Progress progress(run_.talks());
  try
  {
    const auto phase = run_.info().stopwatch().phase(course.phase);
    while (course.goes_on())
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
      }
      ++step_;
      course.after_step(simulation_.step());
      if (step_ % input_.energy_interval == 0)
        record_.energies();
      if (input_.frame_interval > 0. && simulation_.state().time >= next_frame_)
      {
        // What is known so far is on disk from here on.
        add_frame();
        write_tables();
        next_frame_ += input_.frame_interval;
      }
      if (progress.due())
      {
        const auto [text, done] = course.progress();
        progress.show("step " + std::to_string(step_) + text, done);
      }
    }
    record_.energies();
    run_.info().add("divided_steps", static_cast<std::uint64_t>(simulation_.n_divided_steps()));
  }
  catch (const SolverError &)
  {
    // The last sound state, and what was noted until then.
    add_frame();
    write_tables();
    throw;
  }
  add_frame();
  write_tables();
}

} // namespace verification
