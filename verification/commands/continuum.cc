#include <cmath>
#include <optional>
#include <sstream>

#include "continuum/errors.h"
#include "verification/commands/finite_elements.h"
#include "verification/output/checkpoints.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{
namespace
{

// Reports a step that makes too many of them, or is longer than a relaxation time.
void check_time_step(const input::Case &input, double step, input::Parameters &parameters)
{
  resources::check_steps(input, step, parameters);
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number))
      input.shell(number).check_relaxation_times(parameters, input::Case::shell_sections[number], step,
                                                 {"Continuum/time step"});
}

} // namespace

support::ExitCode run_continuum(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  const bool moves = input.continuum.solution == input::ContinuumCase::Solution::motion;
  input::require_constant_loading(input, parameters, "the finite elements have one loading");
  input::require_no_plasticity(input, parameters, "the finite elements have no plastic strain");
  if (input.continuum.has_equilibrium())
    input.continuum.require_equilibrium(parameters, input, "`latcon continuum`");
  if (moves && !(input.end_time > 0.))
    parameters.error("Time/end", "motion needs an end time larger than 0", {"Continuum/solution"});
  if (moves && input.continuum.time_step && parameters.good())
    check_time_step(input, *input.continuum.time_step, parameters);
  parameters.finish();

  const resources::ContinuumSize size = resources::continuum_size(input);
  const resources::MemoryNeed memory = resources::continuum_memory(input, size);
  if (options.dry_run)
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
  if (!options.yes)
    resources::require_memory(memory);
  bridge::ContinuumModel model(input);
  if (moves && !input.continuum.time_step)
  {
    check_time_step(input, motion_time_step(input, model), parameters);
    parameters.finish();
  }
  std::optional<MovingSheet> sheet_in_motion;
  if (moves)
    sheet_in_motion.emplace(input, model);
  const double steps = moves ? std::ceil(input.end_time / motion_time_step(input, model)) : 0.;
  const double frames =
    2. + (moves && input.frame_interval > 0. ? std::floor(input.end_time / input.frame_interval) : 0.);
  const double seconds = resources::continuum_seconds(input, size, steps, frames);
  if (options.dry_run)
  {
    const continuum::Sheet sheet(model.mesh(), model.constitution(), input.continuum.degree, model.conditions());
    std::ostringstream text;
    text << "# continuum: " << model.mesh().n_global_active_cells() << " cells, " << sheet.dof_handler().n_dofs()
         << " unknowns\n";
    if (!input.continuum.mesh_file.empty())
      text << "# mesh: " << model.mesh_extent()[0] << " m x " << model.mesh_extent()[1] << " m\n";
    if (input.continuum.gradient != input::ContinuumGradient::none)
      text << "# lengths: static " << model.static_length() << " m, inertia " << model.inertia_length() << " m\n";
    if (moves)
      text << "# motion: time step " << motion_time_step(input, model) << " s, " << steps << " steps\n";
    text << "# time: about " << std::ceil(seconds) << " s\n";
    print_dry_run(options, text.str());
    require_time(options, seconds);
    return support::ExitCode::done;
  }
  require_time(options, seconds);
  output::Checkpoints checkpoints(options, parameters, input, "continuum");
  Run run(options, &parameters, &checkpoints);
  try
  {
    const output::Results results =
      moves ? motion(input, model, *sheet_in_motion, checkpoints, run) : equilibrium(input, model, run);
    return run.finish(results);
  }
  catch (const output::UnusableCheckpoint &)
  {
    throw;
  }
  // The input has been checked, so the computed state is wrong.
  catch (const continuum::NonPhysicalState &failure)
  {
    throw support::SolverError(failure.what());
  }
  catch (const support::InputError &failure)
  {
    throw support::SolverError(failure.what());
  }
}

} // namespace latcon::commands
