#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <utility>

#include <deal.II/base/mpi.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/field_writer.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/continuum_model.h"
#include "verification/bridge/field_function.h"
#include "verification/bridge/homogenised_memory.h"
#include "verification/commands/command.h"
#include "verification/commands/continuum_commands.h"
#include "verification/commands/cost.h"
#include "verification/commands/motion.h"
#include "verification/commands/signals.h"
#include "verification/output/continuum_record.h"
#include "verification/output/mechanism_names.h"
#include "verification/resources/continuum_resources.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{
namespace
{

continuum::StaticSettings static_settings(const input::Case &input)
{
  continuum::StaticSettings settings;
  settings.degree = input.continuum.degree;
  settings.relative_tolerance = input.continuum.relative_tolerance;
  settings.first_load_step = input.continuum.first_load_step;
  settings.smallest_load_step = std::min(settings.smallest_load_step, settings.first_load_step);
  settings.linear.direct_limit = input.continuum.direct_limit;
  return settings;
}

// Prints Newton iterations with their linear iterations, and records times.
void note(Run &run, const continuum::SolverReport &report)
{
  output::Stopwatch &stopwatch = run.info().stopwatch();
  stopwatch.add("assembly", report.times.assembly);
  stopwatch.add("preconditioner", report.times.preconditioner);
  stopwatch.add("linear solve", report.times.linear_solve);
  if (run.is_verbose())
    std::cout << report.text();
}

// An equilibrium writes no checkpoints to resume from.
output::Results equilibrium(const input::Case &input, bridge::ContinuumModel &model, output::Checkpoints &checkpoints,
                            Run &run)
{
  checkpoints.resume([](auto &) {});
  output::ContinuumRecord record;
  continuum::FieldWriter fields(MPI_COMM_WORLD, run.directory());
  auto set_up = std::make_unique<output::Stopwatch::Phase>(run.info().stopwatch(), "set-up");
  continuum::StaticSolver solver(model.mesh(), model.constitution(), model.conditions(), static_settings(input));
  set_up.reset();
  const auto write_frame = [&](double load_factor)
  {
    const auto phase = run.info().stopwatch().phase("output");
    fields.add_frame(load_factor, solver.sheet(), solver.displacement());
  };
  write_frame(0.);
  const auto write_tables = [&]
  {
    if (run.is_root())
      record.write(run.directory());
  };
  const std::size_t n_cycles = input.continuum.adaptive_cycles;
  const auto find_equilibrium = [&](const std::string &phase_name, auto &&find)
  {
    const auto phase = run.info().stopwatch().phase(phase_name);
    try
    {
      const continuum::SolverReport report = find();
      record.newton(report);
      note(run, report);
    }
    catch (const continuum::SolverFailed &failure)
    {
      // Keeps the results so far.
      record.newton(failure.report());
      write_tables();
      throw;
    }
  };
  find_equilibrium("solve",
                   [&]
                   {
                     return solver.solve(
                       [&](double load_factor)
                       {
                         record.equilibrium(solver);
                         // The frame at full load is that of the last mesh.
                         if (load_factor < 1.)
                           write_frame(load_factor);
                         write_tables();
                       });
                   });
  record.mesh(solver);
  for (std::size_t cycle = 1; cycle <= n_cycles; ++cycle)
  {
    solver.refine(model.mesh(), input.continuum.refined_fraction);
    find_equilibrium("adaptive cycles", [&] { return solver.equilibrate(); });
    record.equilibrium(solver);
    record.mesh(solver);
    write_tables();
    if (run.is_verbose())
      std::cout << "cycle " << cycle << ": " << solver.sheet().mesh().n_global_active_cells() << " cells, "
                << solver.sheet().dof_handler().n_dofs() << " unknowns, largest reaction " << record.largest_reaction()
                << " N/m, changed by " << record.reaction_change() << "\n";
  }
  write_frame(1.);

  output::Results results;
  const auto add = [&results](const std::string &quantity, const std::string &unit, double value) {
    results.add({"continuum", quantity, unit, {}, value, {}, {}, {}});
  };
  add("unknowns", "1", solver.sheet().dof_handler().n_dofs());
  add("elastic energy per thickness", "J/m", solver.total_energy());
  for (const auto &[id, force] : solver.reactions())
    for (const unsigned int i : {0u, 1u})
      add("force on the " + output::edge_name(id) + " edge per thickness, " + (i == 0 ? "x" : "y"), "N/m", force[i]);
  const continuum::DeterminantRange range = solver.determinant_range();
  add("smallest area ratio", "1", range.smallest);
  add("largest area ratio", "1", range.largest);
  if (n_cycles > 0)
    results.add({"continuum",
                 "largest reaction, relative change in the last adaptive cycle",
                 "N/m",
                 {},
                 record.largest_reaction(),
                 {},
                 record.reaction_change(),
                 input.continuum.reaction_tolerance});
  if (run.is_root())
    record.write(run.directory());
  return results;
}

// Nodal displacement of the equilibrium under the boundary conditions of the case.
continuum::Sheet::Vector equilibrium_displacement(const input::Case &input, const bridge::ContinuumModel &model,
                                                  const continuum::Sheet &sheet, Run &run)
{
  const auto phase = run.info().stopwatch().phase("equilibrium");
  continuum::StaticSolver solver(sheet.mesh(), model.constitution(), model.conditions(), static_settings(input));
  note(run, solver.solve());
  continuum::Sheet::Vector u = sheet.make_owned();
  u = solver.displacement();
  return u;
}

// Returns the step that resolves the waves that the mesh resolves, and the fastest relaxation: half the time in which a
// longitudinal wave crosses a cell, at most a tenth of the shortest relaxation time (theory-continuum.md, "Default time
// step").
double motion_time_step(const input::Case &input, bridge::ContinuumModel &model)
{
  if (input.continuum.time_step)
    return *input.continuum.time_step;
  double smallest = model.extent();
  for (const auto &cell : model.mesh().active_cell_iterators())
    smallest = std::min(smallest, cell->minimum_vertex_distance());
  smallest = dealii::Utilities::MPI::min(smallest, MPI_COMM_WORLD);
  double longest = 0.5 * smallest / model.subject().theory.longitudinal_speed;
  if (const auto memory = bridge::homogenised_memory(input.lattice(), model.subject().material))
    for (const continuum::MaxwellFibres &fibres : memory->families())
      for (const continuum::MaxwellBranch &branch : fibres.branches)
        longest = std::min(longest, 0.1 * branch.relaxation_time);
  return input.end_time / std::ceil(input.end_time / longest); // so that the last step ends at the end
}

continuum::DynamicSettings dynamic_settings(const input::Case &input, bridge::ContinuumModel &model)
{
  const input::ContinuumCase &c = input.continuum;
  continuum::DynamicSettings settings;
  settings.time_step = motion_time_step(input, model);
  settings.degree = c.degree;
  settings.relative_tolerance = c.relative_tolerance;
  settings.linear.direct_limit = c.direct_limit;
  if (c.rule == input::ContinuumCase::Rule::generalised_alpha)
    settings.rule = continuum::NewmarkParameters::generalised_alpha(c.spectral_radius);
  return settings;
}

// Sheet that moves, before its first step, whose input is valid.
struct MovingSheet
{
  continuum::DynamicSettings settings;
  std::unique_ptr<continuum::Viscosity> viscosity;
  std::unique_ptr<continuum::FibreMemory> memory;
  continuum::DynamicSolver solver;
  continuum::Sheet::Vector added, velocity; // nodal fields that are added to the base state

  // @throws InputError, continuum::InvalidInput for what start() would refuse
  MovingSheet(const input::Case &input, bridge::ContinuumModel &model)
    : settings(dynamic_settings(input, model)),
      viscosity(
        bridge::homogenised_viscosity(input.lattice(), model.subject().material, model.viscous_gradient_length())),
      memory(bridge::homogenised_memory(input.lattice(), model.subject().material)),
      solver(model.mesh(), model.constitution(), model.conditions(), {input.density, model.inertia_length()}, settings,
             viscosity.get(), {}, memory.get()),
      added(interpolated(bridge::FieldFunction(input.continuum.initial_displacement, model.extent()))),
      velocity(interpolated(bridge::FieldFunction(input.continuum.initial_velocity, model.extent())))
  {
    continuum::Sheet::Vector u = solver.sheet().make_owned();
    if (input.continuum.initial_base == input::ContinuumCase::Base::equilibrium)
      u = solver.prescribed_displacement(); // as of an equilibrium
    else
      add_loading(input, u);
    u += added;
    solver.check_start(u, velocity);
  }

  void start(const input::Case &input, const bridge::ContinuumModel &model, Run &run)
  {
    continuum::Sheet::Vector u = solver.sheet().make_owned();
    if (input.continuum.initial_base == input::ContinuumCase::Base::equilibrium)
      u = equilibrium_displacement(input, model, solver.sheet(), run);
    else
      add_loading(input, u);
    u += added;
    solver.start(u, velocity);
  }

private:
  continuum::Sheet::Vector interpolated(const dealii::Function<2> &field) const
  {
    const continuum::Sheet &sheet = solver.sheet();
    continuum::Sheet::Vector values = sheet.make_owned();
    dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), field, values);
    return values;
  }

  void add_loading(const input::Case &input, continuum::Sheet::Vector &u) const
  {
    if (input.continuum.initial_base == input::ContinuumCase::Base::loading)
      u += interpolated(bridge::AffineDisplacement(input.deformation()));
  }
};

// Results of a motion at its end, or where it was interrupted.
output::Results motion_results(const continuum::DynamicSolver &solver, const output::LedgerCheck &check,
                               double time_step)
{
  output::Results results;
  const continuum::EnergyLedger &ledger = solver.ledger();
  const auto add = [&results](const std::string &quantity, const std::string &unit, double value) {
    results.add({"continuum", quantity, unit, {}, value, {}, {}, {}});
  };
  add("unknowns", "1", solver.sheet().dof_handler().n_dofs());
  add("time step", "s", time_step);
  add("elastic energy per thickness", "J/m", ledger.stored);
  add("kinetic energy per thickness", "J/m", ledger.kinetic);
  add("kinetic energy of micro-inertia per thickness", "J/m", ledger.micro_kinetic);
  add("energy dissipated per thickness", "J/m", ledger.dissipated);
  add("work done on the sheet per thickness", "J/m", ledger.work);
  add("energy imbalance per thickness", "J/m", ledger.imbalance);
  results.add({"continuum",
               "energy imbalance over energy exchanged",
               "1",
               {},
               check.imbalance(),
               {},
               check.imbalance(),
               output::allowed_imbalance_of_implicit_motion(check.rate(), time_step),
               false,
               output::RowKind::ledger});
  return results;
}

// Motion of the finite elements until the end time.
class ElementMotion : public Motion
{
public:
  ElementMotion(const input::Case &input, const bridge::ContinuumModel &model, MovingSheet &sheet,
                output::Checkpoints &checkpoints, Run &run)
    : Motion(input, checkpoints, run), model_(model), sheet_(sheet),
      record_(output::mechanism_names(model.subject().material)), frames_(MPI_COMM_WORLD, run.directory()),
      n_steps_(static_cast<std::size_t>(std::ceil(input.end_time / sheet.settings.time_step * (1. - 1e-12))))
  {
  }

  // Moves the sheet. @return results at the end, or where the motion was interrupted
  output::Results results()
  {
    go("motion");
    run_.info().add("divided_steps", static_cast<std::uint64_t>(solver_.n_divided_steps()));
    run_.info().add("newton_iterations", n_newton_);
    run_.info().add("linear_iterations", n_linear_);
    return motion_results(solver_, record_.ledger(), sheet_.settings.time_step);
  }

private:
  double time() const override { return solver_.time(); }
  double time_of_step() const override { return static_cast<double>(step()) * sheet_.settings.time_step; }
  bool is_complete() const override { return step() >= n_steps_; }
  std::size_t n_frames() const override { return frames_.n_frames(); }
  std::pair<std::string, double> progress() const override
  {
    return {"/" + std::to_string(n_steps_), static_cast<double>(step()) / static_cast<double>(n_steps_)};
  }
  void start() override
  {
    sheet_.start(input_, model_, run_);
    record_.motion(solver_);
    record_.check(solver_);
  }
  void advance() override
  {
    try
    {
      solver_.step();
    }
    catch (const continuum::SolverFailed &failure)
    {
      throw support::SolverError(failure.what());
    }
    record_.check(solver_);
    for (const continuum::NewtonIteration &iteration : solver_.last_report().iterations)
    {
      n_newton_ += iteration.iteration > 0 ? 1 : 0;
      n_linear_ += iteration.linear_iterations;
    }
  }
  void record_energies() override { record_.motion(solver_); }
  void write() override
  {
    const auto phase = run_.info().stopwatch().phase("output");
    if (solver_.time() > frames_.last_time())
      frames_.add_frame(solver_);
    if (run_.is_root())
      record_.write(run_.directory());
  }
  void write_failed() override
  {
    record_energies();
    write();
  }
  void write_resumed() override
  {
    if (run_.is_root())
      record_.write(run_.directory());
    frames_.write_collection();
  }
  void archive(output::CheckpointReader &archive) override { parts(archive); }
  void archive(output::CheckpointWriter &archive) override { parts(archive); }
  template <class Archive>
  void parts(Archive &archive)
  {
    archive("solver", solver_);
    archive("record", record_);
    archive("frames", frames_);
    if (Archive::loads && !(frames_.last_time() <= solver_.time()))
      throw support::InputError("the last frame is of a later time");
    if (Archive::loads && !(record_.last_time() <= solver_.time()))
      throw support::InputError("the last energies are of a later time");
  }

  const bridge::ContinuumModel &model_;
  MovingSheet &sheet_;
  continuum::DynamicSolver &solver_ = sheet_.solver;
  output::ContinuumRecord record_;
  continuum::FieldWriter frames_;
  std::size_t n_steps_;
  std::uint64_t n_newton_ = 0, n_linear_ = 0; // iterations of this run, without those before a checkpoint
};

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
  if (moves && !(input.end_time > 0.))
    parameters.error("Time/end", "motion needs an end time larger than 0", {"Continuum/solution"});
  if (moves && input.continuum.time_step && parameters.good())
    check_time_step(input, *input.continuum.time_step, parameters);
  parameters.finish();

  const resources::ContinuumSize size = resources::continuum_size(input);
  const resources::MemoryNeed memory = resources::continuum_memory(input, size);
  if (options.dry_run)
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
  require_memory(options, memory);
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
  Run run(options, parameters);
  run.record_checkpoint(checkpoints);
  try
  {
    const output::Results results =
      moves ? ElementMotion(input, model, *sheet_in_motion, checkpoints, run).results()
            : equilibrium(input, model, checkpoints, run);
    return interrupted() ? run.interrupted(results) : run.finish(results);
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
