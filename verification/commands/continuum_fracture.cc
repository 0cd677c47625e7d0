#include <cmath>
#include <sstream>

#include <omp.h>

#include "support/ranks.h"
#include "verification/bridge/damaged_sheet.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/continuum_commands.h"
#include "verification/commands/cost.h"
#include "verification/commands/crack_run.h"
#include "verification/commands/motion.h"
#include "verification/output/damage_record.h"
#include "verification/output/damage_writer.h"

namespace latcon::commands
{
namespace
{

// Energy of the sheet, over the one supplied, at which a run has blown up, as on the lattice.
constexpr double blown_up = 2.;

// Motion until the crack reaches the stop position or the time ends. All ranks have the whole sheet and the same
// records; the root rank writes.
class DamageCrack : public Motion
{
public:
  DamageCrack(const input::Case &input, continuum::DamageMotion &motion, bool skip_verification,
              output::Checkpoints &checkpoints, Run &run)
    : Motion(input, checkpoints, run), motion_(motion), skip_verification_(skip_verification),
      seed_tip_(bridge::seed_segment(input, motion.grid()).right), stop_(input.stop_position * input.length),
      record_(input, motion, seed_tip_), frames_(run.directory(), bridge::to_continuum(input.deformation()))
  {
  }

  const output::DamageRecord &record() const { return record_; }

  void write_measurement(const analysis::CrackMeasurement &measurement) const
  {
    if (run_.is_root())
      record_.write_measurement(run_.directory(), measurement, skip_verification_);
  }

private:
  double time() const override { return motion_.time(); }
  double time_of_step() const override { return step() == motion_.n_steps() ? motion_.time() : -1.; }
  bool is_complete() const override { return !(time() < input_.end_time && record_.tip().X() < stop_); }
  std::size_t n_frames() const override { return frames_.series().n_frames(); }
  std::pair<std::string, double> progress() const override
  {
    return {crack_progress(time(), record_.tip()),
            std::max((record_.tip().X() - seed_tip_) / (stop_ - seed_tip_), time() / input_.end_time)};
  }
  void start() override
  {
    record_.step();
    record_.energies();
  }
  void advance() override
  {
    try
    {
      motion_.advance();
    }
    catch (const continuum::NonPhysicalState &failure)
    {
      fail(failure.what(), step() + 1);
    }
    catch (const continuum::LinearSolverFailed &failure)
    {
      fail(failure.what(), step() + 1);
    }
    record_.step();
  }
  void record_energies() override
  {
    record_.energies();
    const continuum::DamageMotionLedger &e = motion_.ledger();
    const double held = e.elastic + e.kinetic + e.gradient;
    if (!(held <= blown_up * (held + e.viscous + e.fracture + e.shed + e.imbalance)))
      fail("the energy of the sheet is more than twice the energy supplied", step());
  }
  void write() override
  {
    if (!run_.is_root())
      return;
    frames_.add_frame(motion_);
    record_.write_tables(run_.directory());
  }
  void write_failed() override
  {
    write();
    write_measurement(record_.measure());
  }
  void write_resumed() override
  {
    if (!run_.is_root())
      return;
    record_.write_tables(run_.directory());
    frames_.series().write_collection();
  }
  void archive(output::CheckpointReader &archive) override { parts(archive); }
  void archive(output::CheckpointWriter &archive) override { parts(archive); }
  template <class Archive>
  void parts(Archive &archive)
  {
    archive("motion", motion_);
    archive("record", record_);
    archive("frames", frames_);
  }

  // The input has been checked, so the computed state is wrong.
  [[noreturn]] static void fail(const std::string &cause, const std::size_t number)
  {
    throw support::SolverError(cause + ", in step " + std::to_string(number) +
                               "; the last frame and crack.json are of the last valid state; try a smaller "
                               "Continuum/time step, or more viscosity if the flanks of the crack collapse against the "
                               "held edges");
  }

  continuum::DamageMotion &motion_;
  bool skip_verification_;
  double seed_tip_, stop_; // [m]
  output::DamageRecord record_;
  output::DamageWriter frames_;
};

} // namespace

support::ExitCode run_continuum_fracture(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  bridge::require_fracture_case(input, parameters);
  input::require_constant_loading(input, parameters, "a crack of the finite elements has one loading");
  if (input.breaking.rule != input::BreakingCase::Rule::critical_stretch || !input.breaking.shell_factors.empty())
    parameters.error("Fracture/rule", "the damage of the finite elements knows one stretch; give critical-stretch",
                     {"Fracture/shell factors"});
  for (const std::size_t id : {2, 3})
    if (input.continuum.edges[id].is_roller())
      parameters.error(
        input.continuum.edges[id].name + "/condition",
        "a crack of the finite elements has no rollers; give displacement = loading for both components");
  const bridge::DamagedSheet sheet = bridge::damaged_sheet(input, parameters);
  resources::check_steps(input, sheet.step, parameters);
  parameters.finish();

  const double steps = std::ceil(input.end_time / sheet.step);
  // Every rank has the whole sheet.
  const double ranks = support::n_ranks();
  resources::MemoryNeed memory = resources::damage_memory(sheet.cells);
  memory.shared *= ranks;
  if (options.dry_run)
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
  require_memory(options, memory);
  continuum::DamageMotion motion = bridge::damage_motion(input, sheet);
  const double seconds = resources::damage_seconds(sheet.cells, steps * sheet.stages) / (ranks * omp_get_max_threads());
  if (options.dry_run)
  {
    const continuum::NodeGrid &grid = motion.grid();
    std::ostringstream text;
    text << "# continuum: " << grid.cells_x << " x " << grid.cells_y << " cells of " << grid.size_x << " m x "
         << grid.size_y << " m\n# damage: length " << sheet.law.length << " m, threshold " << sheet.law.threshold
         << " J/m^3, energy of a crack " << sheet.law.fracture_energy() << " J/m^2\n# time step: " << sheet.step
         << " s, " << steps << " steps at most of " << sheet.stages << " stages each\n# time: about "
         << std::ceil(seconds) << " s at most on " << ranks * omp_get_max_threads()
         << " cores, without claims, pictures and page\n";
    print_dry_run(options, text.str());
    require_time(options, seconds);
    return support::ExitCode::done;
  }
  require_time(options, seconds);

  output::Checkpoints checkpoints(options, parameters, input, "fracture --side continuum");
  // Without a checkpoint nothing of an earlier run, perhaps one of the lattice, is continued: its files are moved
  // aside.
  input::Options started = options;
  started.resume = checkpoints.found().has_value();
  Run run(started, parameters);
  run.record_checkpoint(checkpoints);
  run.info().add("side", std::string("continuum"));
  run.info().add("skip_verification", options.skip_verification);
  run.info().add("damage_length_m", sheet.law.length);
  run.info().add("damage_threshold_J_m3", sheet.law.threshold);
  run.info().add("fracture_energy_J_m2", sheet.law.fracture_energy());
  run.info().add("cell_size_m", motion.grid().size_x);
  run.info().add("time_step_s", sheet.step);
  run.info().add("stages", static_cast<std::uint64_t>(sheet.stages));
  output::Results results;
  if (!options.skip_verification)
    results = passed_or_reported(input, claims_before_fracture(sheet.subject.material, true),
                                 bridge::laws_of(input), options, run);
  DamageCrack crack(input, motion, options.skip_verification, checkpoints, run);
  crack.go("fracture");
  const analysis::CrackMeasurement measurement = crack.record().measure();
  crack.write_measurement(measurement);
  results.add(measured_results(
    input, measurement, Side::continuum, crack.record().imbalance(),
    output::allowed_imbalance_of_damage(crack.record().mean_speed() * sheet.automatic_step / sheet.law.length,
                                        motion.time() / sheet.automatic_step)));
  return end_crack(input, options, run, results, measurement);
}

} // namespace latcon::commands
