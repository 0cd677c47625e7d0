#include "verification/commands/finite_elements.h"

#include <algorithm>
#include <cmath>

#include <deal.II/base/mpi.h>

#include <nlohmann/json.hpp>

#include "continuum/field_writer.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/continuum_waves.h"
#include "verification/commands/motion.h"
#include "verification/output/continuum_record.h"

namespace latcon::commands
{
namespace
{

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

// Returns the nodal displacement at the start, with `equilibrium` of the base state if that is one.
continuum::Sheet::Vector start_of(const MovingSheet &moving, const input::Case &input,
                                  const std::function<continuum::Sheet::Vector()> &equilibrium)
{
  continuum::Sheet::Vector u = moving.solver.sheet().make_owned();
  if (input.continuum.initial_base == input::ContinuumCase::Base::equilibrium)
    u = equilibrium();
  else if (input.continuum.initial_base == input::ContinuumCase::Base::loading)
    u += claims::interpolated(moving.solver.sheet(), bridge::AffineDisplacement(input.deformation()));
  u += moving.added;
  return u;
}

// Results of a motion at its end, or where it was interrupted.
output::Results motion_results(const continuum::DynamicSolver &solver, const output::LedgerCheck &check,
                               double time_step, double at_rest)
{
  const double imbalance = check.imbalance(at_rest);
  output::Results results;
  const continuum::EnergyLedger &ledger = solver.ledger();
  const auto add =
    [rows = claims::Rows(results, "continuum", "")](const std::string &quantity, const std::string &unit, double value)
  { rows.add(quantity, unit, claims::of_continuum(value)); };
  add("unknowns", "1", solver.sheet().dof_handler().n_dofs());
  add("time step", "s", time_step);
  add("elastic energy per thickness", "J/m", ledger.stored);
  add("kinetic energy per thickness", "J/m", ledger.kinetic);
  add("kinetic energy of micro-inertia per thickness", "J/m", ledger.micro_kinetic);
  add("energy dissipated per thickness", "J/m", ledger.dissipated);
  add("work done on the sheet per thickness", "J/m", ledger.work);
  add("energy imbalance per thickness", "J/m", ledger.imbalance);
  results.add(ledger_row("continuum", claims::of_continuum(imbalance), imbalance,
                         output::allowed_imbalance_of_implicit_motion(check.rate(), time_step)));
  return results;
}

// Motion of the finite elements until the end time.
class ElementMotion : public Motion
{
public:
  ElementMotion(const input::Case &input, const bridge::ContinuumModel &model, MovingSheet &sheet,
                output::Checkpoints &checkpoints, Run &run)
    : Motion(input, checkpoints, run, sheet.settings.time_step), model_(model), sheet_(sheet),
      record_(output::mechanism_names(model.subject().material)), frames_(MPI_COMM_WORLD, run.directory())
  {
  }

  // Moves the sheet. @return results at the end, or where the motion was interrupted
  output::Results results()
  {
    go("motion");
    run_.info().add("divided_steps", solver_.n_divided_steps());
    run_.info().add("newton_iterations", n_newton_);
    run_.info().add("linear_iterations", n_linear_);
    return motion_results(solver_, record_.ledger(), sheet_.settings.time_step,
                          output::energy_at_rest(input_.material(), input_.length * input_.height));
  }

private:
  double time() const override { return solver_.time(); }
  std::size_t n_frames() const override { return frames_.n_frames(); }
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
  std::uint64_t n_newton_ = 0, n_linear_ = 0; // iterations of this run, without those before a checkpoint
};

} // namespace

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

MovingSheet::MovingSheet(const input::Case &input, bridge::ContinuumModel &model)
  : settings(dynamic_settings(input, model)),
    viscosity(
      bridge::homogenised_viscosity(input.lattice(), model.subject().material, model.viscous_gradient_length())),
    memory(bridge::homogenised_memory(input.lattice(), model.subject().material, model.viscous_gradient_length())),
    solver(model.mesh(), model.constitution(), model.conditions(), {input.density, model.inertia_length()}, settings,
           viscosity.get(), memory.get()),
    added(claims::interpolated(solver.sheet(),
                               bridge::FieldFunction(input.continuum.initial_displacement, model.extent()))),
    velocity(
      claims::interpolated(solver.sheet(), bridge::FieldFunction(input.continuum.initial_velocity, model.extent())))
{
  solver.check_start(start_of(*this, input, [&] { return solver.sheet().lift(); }), velocity);
}

void MovingSheet::start(const input::Case &input, const bridge::ContinuumModel &model, Run &run)
{
  solver.start(start_of(*this, input, [&] { return equilibrium_displacement(input, model, solver.sheet(), run); }),
               velocity);
}

output::Results motion(const input::Case &input, const bridge::ContinuumModel &model, MovingSheet &sheet,
                       output::Checkpoints &checkpoints, Run &run)
{
  return ElementMotion(input, model, sheet, checkpoints, run).results();
}

} // namespace latcon::commands
