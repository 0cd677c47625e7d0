#include <cmath>

#include <nlohmann/json.hpp>

#include "lattice/relaxation.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/bridge/plane_waves.h"
#include "verification/bridge/small_strain.h"
#include "verification/commands/command.h"
#include "verification/commands/motion.h"
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
  double residual = 0.;
  try
  {
    const auto phase = run.info().stopwatch().phase("relaxation");
    residual = lattice::relax(state, sheet, material,
                              1e-12 * bridge::small_strain(sheet, material).shear_modulus * input.spacing);
  }
  catch (const std::runtime_error &error)
  {
    throw support::SolverError(error.what());
  }
  state.time = 1.; // load factor, as for the continuum
  fields.add_frame(state);
  output::Results results;
  const claims::Rows rows(results, "lattice", "");
  rows.add("elastic energy per thickness", "J/m", claims::of_lattice(lattice::elastic_energy(state, sheet, material)));
  rows.add("largest force on a free site, per thickness", "N/m", claims::of_lattice(residual));
  return results;
}

// Returns the tolerance of the ledger of a motion. Its energy is exchanged in all automatic steps, or in those in which
// noise decays as the shortest waves do (theory.md, eqs. (L.40) and (L.44)).
output::Tolerance allowed_imbalance(const input::Case &input, const lattice::TriangularLattice &sheet,
                                    const lattice::Material &material, double time)
{
  const double step = input.automatic().lattice_time_stepping().step;
  lattice::Material fast = material; // with the stiffness of memories in fast motion in place of the viscosity
  for (std::optional<lattice::Shell> *const shell : {&fast.next_nearest, &fast.third_nearest})
    if (shell->has_value())
      (*shell)->viscosity = lattice::properties((*shell)->memory).largest_stiffness;
  fast.nearest.viscosity = lattice::properties(fast.nearest.memory).largest_stiffness;
  double rate = 0., frequency = 0.; // overdamped waves have none
  constexpr int n = 12;             // of a grid over a cell of the reciprocal lattice
  for (int i = 0; i < n; ++i)
    for (int j = i == 0 ? 1 : 0; j < n; ++j)
    {
      const Eigen::Vector2d K =
        2. * M_PI / (n * input.spacing * input.spacing) * sheet.grid().from_row_frame(i, (2 * j - i) / 1.5);
      bridge::WaveMatrices matrices = bridge::bloch_matrices(sheet, material, input.deformation(), K);
      if (i == 0 && 2 * j == n && input.noise_amplitude > 0.)
        for (const bridge::PlaneWave &wave : bridge::plane_waves(matrices, K.normalized()))
          rate += wave.decay;
      matrices.stiffness += bridge::bloch_matrices(sheet, fast, input.deformation(), K).damping;
      for (const bridge::PlaneWave &wave : bridge::plane_waves(matrices, K.normalized()))
        frequency = support::largest_of({frequency, wave.frequency});
    }
  const output::Tolerance allowed = output::allowed_imbalance(
    input.integrator, rate == 0. ? time / step : -std::expm1(-rate * time) / (rate * step), 4.);
  const double s = support::smallest_of({std::pow(0.5 * step * frequency, 2), 1e-2}), shift = s / (1. - s);
  if (input.integrator == input::Case::Integrator::velocity_verlet && shift > *allowed)
    return {shift, "velocity Verlet conserves another energy of the shortest waves (L.44); at most 1e-2"};
  return allowed;
}

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
  LatticeMotion motion(input, simulation, checkpoints, run);
  motion.go("motion");
  run.info().add("divided_steps", simulation.n_divided_steps());
  output::Results results;
  const lattice::EnergyBalance energies = simulation.energies();
  const claims::Rows rows(results, "lattice", "");
  rows.add("elastic energy per thickness", "J/m", claims::of_lattice(energies.elastic));
  rows.add("kinetic energy per thickness", "J/m", claims::of_lattice(energies.kinetic));
  const double imbalance = motion.record().imbalance();
  results.add(ledger_row("lattice", claims::of_lattice(imbalance), imbalance,
                         allowed_imbalance(input, band.lattice(), material, simulation.state().time)));
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
  if (!is_to_be_run(options, parameters, input, input.lattice_time_stepping(),
                    moves ? resources::RunKind::dynamics : resources::RunKind::equilibrium))
    return support::ExitCode::done;
  output::Checkpoints checkpoints(options, parameters, input, "lattice");
  Run run(options, &parameters, &checkpoints);
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
  return run.finish(results);
}

} // namespace latcon::commands
