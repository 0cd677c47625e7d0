#include <algorithm>
#include <string>

#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/cost.h"
#include "verification/commands/crack_run.h"
#include "verification/commands/dry_run.h"
#include "verification/commands/motion.h"
#include "verification/input/cracked_sheet.h"
#include "verification/output/crack_film.h"
#include "verification/output/near_tip_record.h"

namespace latcon::commands
{
namespace
{

// Motion until the crack reaches the stop position or the time ends.
class CrackMotion : public LatticeMotion
{
public:
  CrackMotion(const input::Case &input, lattice::Simulation &simulation, double seed_tip,
              output::Checkpoints &checkpoints, Run &run)
    : LatticeMotion(input, simulation, checkpoints, run), seed_tip_(seed_tip),
      stop_(input.stop_position * simulation.lattice().length()), near_tip_(input, simulation, seed_tip),
      film_(input, simulation, record_, seed_tip, run.directory(), writing_)
  {
  }
  output::NearTipRecord &near_tip() { return near_tip_; }
  output::CrackFilm &film() { return film_; }

private:
  bool is_complete() const override { return !(time() < input_.end_time && record_.tip().X() < stop_); }
  std::pair<std::string, double> progress() const override
  {
    return {crack_progress(time(), record_.tip()) + ", " + std::to_string(simulation_.n_broken()) + " bonds broken",
            std::max((record_.tip().X() - seed_tip_) / (stop_ - seed_tip_), time() / input_.end_time)};
  }
  void start() override
  {
    LatticeMotion::start();
    film_.begin(false);
  }
  void write_resumed() override
  {
    LatticeMotion::write_resumed();
    film_.begin(true);
  }
  void after_step(const std::vector<lattice::BrokenBond> &broken) override
  {
    record_.step(broken);
    near_tip_.step();
    film_.step();
  }
  void archive(output::CheckpointReader &archive) override { parts(archive); }
  void archive(output::CheckpointWriter &archive) override { parts(archive); }
  template <class Archive>
  void parts(Archive &archive)
  {
    LatticeMotion::archive(archive);
    archive("near_tip", near_tip_);
    archive("film", film_);
  }

  double seed_tip_, stop_; // [m]
  output::NearTipRecord near_tip_;
  output::CrackFilm film_;
};

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

  const double seed_tip = input.seed_tip(sheet);
  CrackMotion motion(input, simulation, seed_tip, checkpoints, run);
  motion.go("fracture");
  run.info().add("divided_steps", static_cast<std::uint64_t>(simulation.n_divided_steps()));
  motion.film().end();
  output::CrackRecord &record = motion.record();
  const analysis::CrackMeasurement crack = record.measure(seed_tip);
  record.write_measurement(run.directory(), crack, seed_tip, input, skip_verification);
  if (run.is_root())
    motion.near_tip().write(run.directory(), crack);
  return {crack, measured_results(
                   input, crack, record.imbalance(),
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

  const lattice::TriangularLattice sheet = input.sheet();
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

  output::Checkpoints checkpoints(options, parameters, input,
                                  options.on_continuum ? "fracture --side continuum" : "fracture");
  Run run(options, parameters);
  run.record_checkpoint(checkpoints);
  if (options.on_continuum)
  {
    run.info().add("side", std::string("continuum"));
    run.info().add("grid_spacing_m", sheet.spacing());
    run.info().add("half_bonds", static_cast<std::uint64_t>(sheet.n_kinds()));
  }
  run.info().add("skip_verification", options.skip_verification);
  output::Results results;
  if (claims)
    results = passed_or_reported(input, claims_before_fracture(material, options.on_continuum),
                                 bridge::laws_of_lattice(), options, run);
  const Crack crack = run_crack(input, sheet, options.skip_verification, checkpoints, run);
  results.add(crack.results);
  return end_crack(input, options, run, results, crack.measurement);
}

} // namespace latcon::commands
