#include <sstream>

#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/cost.h"
#include "verification/commands/crack_run.h"
#include "verification/commands/dry_run.h"
#include "verification/commands/lattice_motion.h"
#include "verification/input/cracked_sheet.h"
#include "verification/output/crack_film.h"
#include "verification/output/near_tip_record.h"

namespace latcon::commands
{
namespace
{

std::string progress_text(const lattice::Simulation &simulation, const output::CrackRecord &record)
{
  std::ostringstream text;
  text.precision(3);
  text << ", t " << 1e3 * simulation.state().time << " ms, tip " << 100. * record.tip_X() << " cm, speed "
       << record.speed() << " m/s, " << simulation.n_broken() << " bonds broken";
  return text.str();
}

struct Crack
{
  analysis::CrackMeasurement measurement;
  output::Results results;
};

// Moves the sheet until the crack reaches the stop position or the time ends. Collective, with the same results on
// every rank.
Crack run_crack(const input::Case &input, const lattice::TriangularLattice &sheet, bool skip_verification,
                output::Checkpoints &checkpoints, Run &run)
{
  const lattice::RowPartition band(sheet, MPI_COMM_WORLD);
  const std::unique_ptr<lattice::Simulation> cracked = input::cracked_sheet(input, band);
  lattice::Simulation &simulation = *cracked;

  LatticeMotion motion(input, simulation, checkpoints, run);
  output::CrackRecord &record = motion.record();
  const double stop = input.stop_position * sheet.length();
  const double seed_tip = sheet.reference(input.seed(sheet).back()).x();
  output::NearTipRecord near_tip(input, simulation, seed_tip);
  output::CrackFilm film(input, simulation, record, seed_tip, run.directory(), motion.writing());
  motion.go({"fracture", [&] { return simulation.state().time < input.end_time && record.tip_X() < stop; },
             [&](const std::vector<lattice::BrokenBond> &broken)
             {
               record.step(broken);
               near_tip.step();
               film.step();
             },
             [&]
             {
               return std::pair(
                 progress_text(simulation, record),
                 std::max((record.tip_X() - seed_tip) / (stop - seed_tip), simulation.state().time / input.end_time));
             },
             [&](bool resumed) { film.begin(resumed); }},
            [&](auto &archive)
            {
              archive("near_tip", near_tip);
              archive("film", film);
            });
  film.end();
  const analysis::CrackMeasurement crack = record.measure(seed_tip);
  record.write_measurement(run.directory(), crack, seed_tip, *input.breaking_stretch, skip_verification);
  if (run.is_root())
    near_tip.write(run.directory(), crack);
  return {crack, measured_results(
                   input, crack, Side::lattice, record.imbalance(),
                   output::allowed_imbalance_of_crack(
                     input.integrator, simulation.state().time / input.automatic().fracture_time_stepping().step))};
}

} // namespace

support::ExitCode run_fracture(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  bridge::require_fracture_case(input, parameters);
  if (parameters.good())
    resources::check_steps(input, input.fracture_time_stepping().step, parameters);
  if (!options.skip_verification)
    claims::check_user_laws(input, parameters);
  parameters.finish();

  const lattice::TriangularLattice sheet = input.lattice();
  const lattice::Material material = input.material();
  const lattice::TimeStepping stepping = input.fracture_time_stepping();
  const double seconds = rough_seconds(input, stepping, resources::expected_steps(input, stepping));
  const bool claims = !options.skip_verification;
  const resources::MemoryNeed memory = resources::lattice_memory(input, resources::RunKind::fracture, claims);
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
    require_memory(options, memory);
    if (!options.quiet)
      print_dry_run(options, lattice_text(input, stepping, resources::RunKind::fracture, claims, !options.no_report));
    require_time(options, seconds);
    return support::ExitCode::done;
  }
  require_memory(options, memory);
  require_time(options, seconds);

  output::Checkpoints checkpoints(options, parameters, input, "fracture");
  Run run(options, parameters);
  run.record_checkpoint(checkpoints);
  run.info().add("skip_verification", options.skip_verification);
  output::Results results;
  if (claims)
    results = passed_or_reported(input, claims_before_fracture(material), bridge::laws_of_lattice(), options, run);
  const Crack crack = run_crack(input, sheet, options.skip_verification, checkpoints, run);
  results.add(crack.results);
  return end_crack(input, options, run, results, crack.measurement);
}

} // namespace latcon::commands
