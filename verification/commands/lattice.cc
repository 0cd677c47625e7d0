#include <cmath>
#include <iostream>

#include "lattice/relaxation.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/bridge/plane_waves.h"
#include "verification/bridge/small_strain.h"
#include "verification/commands/command.h"
#include "verification/commands/cost.h"
#include "verification/commands/dry_run.h"
#include "verification/commands/motion.h"
#include "verification/commands/signals.h"
#include "verification/output/field_writer.h"

namespace latcon::commands
{
namespace
{

// Computes the static equilibrium. @return its energy and residual
output::Results relaxed(const input::Case &input, const lattice::TriangularLattice &sheet,
                        const lattice::Material &material, lattice::State state, Run &run)
{
  output::FieldWriter fields(sheet, material, run.directory());
  fields.add_frame(state);
  lattice::Relaxation relaxation{};
  try
  {
    const auto phase = run.info().stopwatch().phase("relaxation");
    relaxation = lattice::relax(state, sheet, material,
                                1e-12 * bridge::small_strain(sheet, material).shear_modulus * input.spacing);
  }
  catch (const std::runtime_error &error)
  {
    throw support::SolverError(error.what());
  }
  state.time = 1.; // load factor, as for the continuum
  fields.add_frame(state);
  output::Results results;
  results.add({"lattice",
               "elastic energy per thickness",
               "J/m",
               lattice::elastic_energy(state, sheet, material),
               {},
               {},
               {},
               {}});
  results.add({"lattice", "largest force on a free site, per thickness", "N/m", relaxation.residual, {}, {}, {}, {}});
  return results;
}

// Returns the number of automatic steps in which a motion exchanges its energy: all, or those in which noise decays as
// the shortest waves do (theory.md, eq. (L.40)).
double exchange_steps(const input::Case &input, double time)
{
  const double step = input.automatic().lattice_time_stepping().step;
  if (input.noise_amplitude == 0.)
    return time / step;
  const Eigen::Vector2d K(0., 2. * M_PI / (std::sqrt(3.) * input.spacing));
  const auto waves = bridge::plane_waves(
    bridge::bloch_matrices(input.lattice(), input.material(), input.deformation(), K), K.normalized());
  const double rate = waves[0].decay + waves[1].decay;
  return rate == 0. ? time / step : -std::expm1(-rate * time) / (rate * step);
}

// Motion until the end time.
class FreeMotion : public LatticeMotion
{
public:
  FreeMotion(const input::Case &input, lattice::Simulation &simulation, output::Checkpoints &checkpoints, Run &run)
    : LatticeMotion(input, simulation, checkpoints, run),
      n_steps_(static_cast<std::size_t>(std::ceil(input.end_time / simulation.time_step() * (1. - 1e-12))))
  {
  }

private:
  bool is_complete() const override { return step() >= n_steps_; }
  std::pair<std::string, double> progress() const override
  {
    return {"/" + std::to_string(n_steps_), static_cast<double>(step()) / static_cast<double>(n_steps_)};
  }

  std::size_t n_steps_;
};

// Moves the sheet until the end time. Collective, with the same results on every rank.
output::Results moved(const input::Case &input, const lattice::RowPartition &band, const lattice::Material &material,
                      lattice::State state, output::Checkpoints &checkpoints, Run &run)
{
  lattice::TimeStepping stepping = input.lattice_time_stepping();
  if (!input.time_step)
    stepping.step = input.end_time / std::ceil(input.end_time / stepping.step); // so that the last step ends at the end
  const std::vector<lattice::Constraint> constraints = input::edge_constraints(input, state, band.lattice());
  lattice::Simulation simulation(band, material, std::move(state), stepping);
  for (const lattice::Constraint &constraint : constraints)
    simulation.constrain(constraint);
  FreeMotion motion(input, simulation, checkpoints, run);
  motion.go("motion");
  run.info().add("divided_steps", static_cast<std::uint64_t>(simulation.n_divided_steps()));
  output::Results results;
  const lattice::EnergyBalance energies = simulation.energies();
  results.add({"lattice", "elastic energy per thickness", "J/m", energies.elastic, {}, {}, {}, {}});
  results.add({"lattice", "kinetic energy per thickness", "J/m", energies.kinetic, {}, {}, {}, {}});
  results.add({"lattice",
               "energy imbalance over energy exchanged",
               "1",
               motion.record().imbalance(),
               {},
               {},
               motion.record().imbalance(),
               output::allowed_imbalance_of_motion(input.integrator, exchange_steps(input, simulation.state().time)),
               false,
               output::RowKind::ledger});
  return results;
}

} // namespace

support::ExitCode run_lattice(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  bridge::require_lattice_sheet(input, parameters, "`latcon lattice`");
  if (input.solution == input::Case::Solution::motion && !(input.end_time > 0.))
    parameters.error("Time/end", "motion needs an end time larger than 0", {"Lattice/solution"});
  const bool moves = input.solution == input::Case::Solution::motion;
  if (moves && parameters.good())
    resources::check_steps(input, input.lattice_time_stepping().step, parameters);
  parameters.finish();

  const lattice::TriangularLattice sheet = input.lattice();
  const lattice::Material material = input.material();
  const resources::RunKind kind = moves ? resources::RunKind::dynamics : resources::RunKind::equilibrium;
  const resources::MemoryNeed memory = resources::lattice_memory(input, kind);
  const lattice::TimeStepping stepping = input.lattice_time_stepping();
  const double seconds = moves ? rough_seconds(input, stepping, input.end_time / stepping.step) : 0.;
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
    require_memory(options, memory);
    if (!options.quiet)
      print_dry_run(options, lattice_text(input, stepping, kind));
    require_time(options, seconds);
    return support::ExitCode::done;
  }
  output::Checkpoints checkpoints(options, parameters, input, "lattice");
  require_memory(options, memory);
  require_time(options, seconds);
  Run run(options, parameters);
  run.record_checkpoint(checkpoints);
  output::Results results;
  const auto state_of = [&](const lattice::RowPartition &band)
  {
    lattice::State state = bridge::lattice_state(input, band);
    for (const lattice::Constraint &constraint : input::edge_constraints(input, state, band.lattice()))
      lattice::constrain(state, band, constraint);
    lattice::add_noise(state, band, input.noise_amplitude * input.spacing, input.noise_seed);
    return state;
  };
  if (moves)
  {
    const lattice::RowPartition band(sheet, MPI_COMM_WORLD);
    results = moved(input, band, material, state_of(band), checkpoints, run);
  }
  else if (run.is_root()) // the root rank computes the equilibrium
    results = relaxed(input, sheet, material, state_of(sheet), run);
  return interrupted() ? run.interrupted(results) : run.finish(results);
}

} // namespace latcon::commands
