#include <cmath>
#include <iostream>

#include "lattice/field_writer.h"
#include "lattice/relaxation.h"
#include "verification/checkpoint/checkpoints.h"
#include "verification/commands/command.h"
#include "verification/commands/dry_run.h"
#include "verification/fracture/crack_record.h"
#include "verification/homogenisation.h"
#include "verification/lattice_sheet.h"
#include "verification/progress.h"

namespace verification
{
namespace
{

// Static equilibrium. @return its energy and residual
Results relaxed(const Case &input, const lattice::TriangularLattice &sheet, const lattice::Material &material,
                lattice::State state, Run &run)
{
  lattice::FieldWriter fields(sheet, material, run.directory());
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
    throw SolverError(error.what());
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
Results moved(const Case &input, const lattice::RowBand &band, const lattice::Material &material, lattice::State state,
              Checkpoints &checkpoints, Run &run)
{
  lattice::TimeStepping stepping = input.lattice_time_stepping();
  if (!input.time_step)
    stepping.step = input.end_time / std::ceil(input.end_time / stepping.step); // so that the last step ends at the end
  lattice::Simulation simulation(band, material, std::move(state), stepping);
  lattice::FieldWriter fields(band.lattice(), material, run.directory());
  const auto add_frame = [&]
  {
    const lattice::State &whole = simulation.gather();
    if (run.writes())
      fields.add_frame(whole);
  };
  CrackRecord record(simulation);
  const auto write_tables = [&]
  {
    if (run.writes())
      record.write_tables(run.directory());
  };
  double next_frame = input.frame_interval;
  std::size_t step = 0; // done
  const auto parts = [&](auto &archive)
  {
    archive("simulation", simulation);
    archive("record", record);
    archive("frames", fields);
    archive("next_frame", next_frame);
    archive("step", step);
  };
  const auto write_checkpoint = [&]
  {
    record.check();
    checkpoints.write(step, simulation.state().time, parts);
  };
  if (checkpoints.resume(parts))
  {
    // What was written after the checkpoint goes.
    write_tables();
    if (run.writes())
      fields.write_collection();
  }
  else
  {
    add_frame();
    record.start();
  }
  Progress progress(run.talks());
  try
  {
    const auto phase = run.info().stopwatch().phase("motion");
    const auto steps = static_cast<std::size_t>(std::ceil(input.end_time / stepping.step * (1. - 1e-12)));
    while (step < steps)
    {
      if (step % steps_between_signals == 0)
      {
        if (signal_came_to_any_rank())
        {
          write_checkpoint();
          break;
        }
        if (checkpoints.due(step))
          write_checkpoint();
      }
      ++step;
      simulation.step();
      if (step % input.energy_interval == 0)
        record.energies();
      if (input.frame_interval > 0. && simulation.state().time >= next_frame && step < steps)
      {
        add_frame();
        next_frame += input.frame_interval;
      }
      if (progress.due())
        progress.show("step " + std::to_string(step) + "/" + std::to_string(steps), static_cast<double>(step) / steps);
    }
    record.energies();
  }
  catch (const SolverError &)
  {
    // The last sound state, and what was noted until then.
    add_frame();
    write_tables();
    throw;
  }
  write_tables();
  if (input.end_time > 0.)
    add_frame();
  Results results;
  const lattice::EnergyBalance energies = simulation.energies();
  results.add({"lattice", "elastic energy per thickness", "J/m", energies.elastic, {}, {}, {}, {}});
  results.add({"lattice", "kinetic energy per thickness", "J/m", energies.kinetic, {}, {}, {}, {}});
  results.add({"lattice",
               "energy imbalance over initial energy",
               "1",
               record.largest_imbalance(),
               {},
               {},
               record.largest_imbalance(),
               1e-4});
  return results;
}

} // namespace

ExitCode run_lattice(const Options &options)
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
  const LatticeRun kind = moves ? LatticeRun::moved : LatticeRun::relaxed;
  const MemoryNeed memory = lattice_memory(input, kind);
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text() + memory_text(memory));
    require_memory(memory);
    if (!options.quiet)
      print_dry_run(options, lattice_text(input, input.lattice_time_stepping(), kind));
    return ExitCode::done;
  }
  Checkpoints checkpoints(options, parameters, input, "lattice");
  require_memory(memory);
  Run run(options, parameters);
  run.note(checkpoints);
  Results results;
  const auto state_of = [&](const lattice::RowBand &band)
  {
    lattice::State state = lattice_state(input, band, lattice::unbreakable);
    lattice::add_noise(state, band, input.noise_amplitude * input.spacing, input.noise_seed);
    return state;
  };
  if (moves)
  {
    const lattice::RowBand band(sheet, MPI_COMM_WORLD);
    results = moved(input, band, material, state_of(band), checkpoints, run);
  }
  else if (run.writes()) // equilibrium is a matter of the first rank
    results = relaxed(input, sheet, material, state_of(sheet), run);
  return signal_came() ? run.interrupted(results) : run.finish(results);
}

} // namespace verification
