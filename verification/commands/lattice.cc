#include <cmath>
#include <iostream>

#include "lattice/relaxation.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/commands/command.h"
#include "verification/commands/dry_run.h"
#include "verification/commands/lattice_motion.h"
#include "verification/commands/signals.h"
#include "verification/output/field_writer.h"

namespace latcon::verification
{
namespace
{

// Static equilibrium. @return its energy and residual
Results relaxed(const Case &input, const lattice::TriangularLattice &sheet, const lattice::Material &material,
                lattice::State state, Run &run)
{
  FieldWriter fields(sheet, material, run.directory());
  fields.add_frame(state);
  lattice::Relaxation relaxation{};
  try
  {
    const auto phase = run.info().stopwatch().phase("relaxation");
    relaxation =
      lattice::relax(state, sheet, material, 1e-12 * small_strain(sheet, material).shear_modulus * input.spacing);
  }
  catch (const std::runtime_error &error)
  {
    throw support::SolverError(error.what());
  }
  state.time = 1.; // load factor, as for the continuum
  fields.add_frame(state);
  Results results;
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

// On every rank, with the same results.
Results moved(const Case &input, const lattice::RowPartition &band, const lattice::Material &material,
              lattice::State state, Checkpoints &checkpoints, Run &run)
{
  lattice::TimeStepping stepping = input.lattice_time_stepping();
  if (!input.time_step)
    stepping.step = input.end_time / std::ceil(input.end_time / stepping.step); // so that the last step ends at the end
  lattice::Simulation simulation(band, material, std::move(state), stepping);
  LatticeMotion motion(input, simulation, checkpoints, run);
  const auto steps = static_cast<std::size_t>(std::ceil(input.end_time / stepping.step * (1. - 1e-12)));
  motion.go({"motion", [&] { return motion.step() < steps; }, [](const auto &) {},
             [&] { return std::pair("/" + std::to_string(steps), static_cast<double>(motion.step()) / steps); }},
            [](auto &) {});
  Results results;
  const lattice::EnergyBalance energies = simulation.energies();
  results.add({"lattice", "elastic energy per thickness", "J/m", energies.elastic, {}, {}, {}, {}});
  results.add({"lattice", "kinetic energy per thickness", "J/m", energies.kinetic, {}, {}, {}, {}});
  results.add({"lattice",
               "energy imbalance over initial energy",
               "1",
               motion.record().largest_imbalance(),
               {},
               {},
               motion.record().largest_imbalance(),
               1e-4});
  return results;
}

} // namespace

support::ExitCode run_lattice(const Options &options)
{
  Case input;
  Parameters parameters;
  read_case(options, input, parameters);
  require_lattice_sheet(input, parameters, "`latcon lattice`");
  if (input.solution == Case::Solution::motion && !(input.end_time > 0.))
    parameters.error("Time/end", "motion needs an end time larger than 0", {"Lattice/solution"});
  const bool moves = input.solution == Case::Solution::motion;
  if (moves && parameters.good())
    check_steps(input, input.lattice_time_stepping().step, parameters);
  parameters.finish();

  const lattice::TriangularLattice sheet = input.lattice();
  const lattice::Material material = input.material();
  const RunKind kind = moves ? RunKind::dynamics : RunKind::equilibrium;
  const MemoryNeed memory = lattice_memory(input, kind);
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text() + memory_text(memory));
    require_memory(memory);
    if (!options.quiet)
      print_dry_run(options, lattice_text(input, input.lattice_time_stepping(), kind));
    return support::ExitCode::done;
  }
  Checkpoints checkpoints(options, parameters, input, "lattice");
  require_memory(memory);
  Run run(options, parameters);
  run.note(checkpoints);
  Results results;
  const auto state_of = [&](const lattice::RowPartition &band)
  {
    lattice::State state = lattice_state(input, band);
    lattice::add_noise(state, band, input.noise_amplitude * input.spacing, input.noise_seed);
    return state;
  };
  if (moves)
  {
    const lattice::RowPartition band(sheet, MPI_COMM_WORLD);
    results = moved(input, band, material, state_of(band), checkpoints, run);
  }
  else if (run.is_root()) // equilibrium is a matter of the first rank
    results = relaxed(input, sheet, material, state_of(sheet), run);
  return interrupted() ? run.interrupted(results) : run.finish(results);
}

} // namespace latcon::verification
