#include <cmath>
#include <sstream>

#include <omp.h>

#include "lattice/archive_rows.h"
#include "support/ranks.h"
#include "verification/bridge/damaged_sheet.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/continuum_commands.h"
#include "verification/commands/cost.h"
#include "verification/commands/crack_run.h"
#include "verification/commands/signals.h"
#include "verification/output/checkpoints.h"
#include "verification/output/damage_record.h"
#include "verification/output/damage_writer.h"
#include "verification/output/progress.h"

namespace latcon::commands
{
namespace
{

// Energy of the sheet, over the one supplied, at which a run has blown up, as on the lattice.
constexpr double blown_up = 2.;

using analysis::CrackMeasurement;

// A crack of the continuum between steps: frames, tables, checkpoints, signals, progress.
class DamageRun
{
public:
  DamageRun(const input::Case &input, continuum::DamageMotion &motion, bool skip_verification,
            output::Checkpoints &checkpoints, Run &run)
    : input_(input), motion_(motion), skip_verification_(skip_verification), checkpoints_(checkpoints), run_(run),
      seed_tip_(bridge::seed_segment(input, motion.grid()).right), record_(input, motion, seed_tip_),
      frames_(run.directory(), bridge::to_continuum(input.deformation())), next_frame_(input.frame_interval)
  {
  }

  // Moves the sheet until the crack reaches the stop position, the time ends or a signal comes.
  void go()
  {
    const bool resumed = checkpoints_.resume([this](auto &archive) { parts(archive); });
    const SignalDeferral deferral;
    if (resumed)
    {
      // Removes what was written after the checkpoint.
      write_tables();
      if (run_.is_root())
        frames_.series().write_collection();
    }
    else
    {
      record_.step();
      record_.energies();
      add_frame();
    }
    output::Progress progress(run_.is_verbose());
    const auto phase = run_.info().stopwatch().phase("fracture");
    const double stop = input_.stop_position * input_.length;
    while (motion_.time() < input_.end_time && record_.tip_X() < stop)
    {
      const bool is_stopped = any_rank_interrupted(); // a step takes far longer
      if (is_stopped || checkpoints_.due(motion_.n_steps()))
        checkpoints_.write(motion_.n_steps(), motion_.time(), [this](auto &archive) { parts(archive); });
      if (is_stopped)
        break;
      step();
      if (progress.due())
        progress.show(progress_text(),
                      std::max((record_.tip_X() - seed_tip_) / (stop - seed_tip_), motion_.time() / input_.end_time));
    }
    record_.energies();
    add_frame();
    write_tables();
  }

  const output::DamageRecord &record() const { return record_; }

private:
  // All ranks have the whole sheet and the same records; the root rank writes.
  void add_frame()
  {
    if (run_.is_root())
      frames_.add_frame(motion_);
  }
  void write_tables() const
  {
    if (run_.is_root())
      record_.write_tables(run_.directory());
  }

  void step()
  {
    const std::size_t number = motion_.n_steps() + 1;
    try
    {
      motion_.advance();
    }
    catch (const continuum::NonPhysicalState &failure)
    {
      fail(failure.what(), number);
    }
    catch (const continuum::LinearSolverFailed &failure)
    {
      fail(failure.what(), number);
    }
    record_.step();
    if (motion_.n_steps() % input_.energy_interval == 0)
    {
      record_.energies();
      const continuum::DamageMotionLedger &e = motion_.ledger();
      const double held = e.elastic + e.kinetic + e.gradient;
      if (!(held <= blown_up * (held + e.viscous + e.fracture + e.shed + e.imbalance)))
        fail("the energy of the sheet is more than twice the energy supplied", number);
    }
    if (input_.frame_interval > 0. && motion_.time() >= next_frame_)
    {
      // All results so far are on disk from here on.
      add_frame();
      write_tables();
      next_frame_ += input_.frame_interval;
    }
  }

  // The input has been checked, so the computed state is wrong. The last valid one is shown, and the records until
  // then.
  [[noreturn]] void fail(const std::string &cause, const std::size_t number)
  {
    std::string records = "crack.json is of what the crack did until then";
    try
    {
      add_frame();
      write_tables();
      if (run_.is_root())
        record_.write_measurement(run_.directory(), record_.measure(), skip_verification_);
    }
    catch (const std::exception &error) // the cause is the message that matters
    {
      records = std::string("what the crack did until then is not on disk: ") + error.what();
    }
    MPI_Barrier(MPI_COMM_WORLD); // the exception of another rank would end the one that writes
    throw support::SolverError(cause + ", in step " + std::to_string(number) + "; " + records +
                               "; try a smaller Continuum/time step, or more viscosity if the flanks of the crack "
                               "collapse against the held edges");
  }

  std::string progress_text() const
  {
    std::ostringstream text;
    text.precision(3);
    text << "step " << motion_.n_steps() << ", t " << 1e3 * motion_.time() << " ms, tip " << 100. * record_.tip_X()
         << " cm, speed " << record_.speed() << " m/s";
    return text.str();
  }

  template <class Archive>
  void parts(Archive &archive)
  {
    std::size_t step = motion_.n_steps();
    archive("motion", motion_);
    archive("record", record_);
    archive("frames", frames_);
    archive("next_frame", next_frame_);
    archive("step", step);
    if constexpr (Archive::loads)
    {
      output::require_matching_time(*checkpoints_.found(), step, motion_.time(), motion_.time(), 0.);
      lattice::require_archived(step == motion_.n_steps(), "`step` is not that of the motion");
      const double frames = static_cast<double>(frames_.series().n_frames());
      lattice::require_archived(input_.frame_interval == 0. ||
                                  std::abs(next_frame_ - frames * input_.frame_interval) <=
                                    frames * std::numeric_limits<double>::epsilon() * next_frame_,
                                "`next_frame` does not follow the frames that there are");
    }
  }

  const input::Case &input_;
  continuum::DamageMotion &motion_;
  bool skip_verification_;
  output::Checkpoints &checkpoints_;
  Run &run_;
  double seed_tip_; // [m]
  output::DamageRecord record_;
  output::DamageWriter frames_;
  double next_frame_; // [s]
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
    results = passed_or_reported(input, claims_before_continuum_fracture(sheet.subject.material),
                                 bridge::laws_of(input), options, run);
  DamageRun crack(input, motion, options.skip_verification, checkpoints, run);
  crack.go();
  const CrackMeasurement measurement = crack.record().measure();
  if (run.is_root())
    crack.record().write_measurement(run.directory(), measurement, options.skip_verification);
  results.add(measured_results(
    input, measurement, Side::continuum, crack.record().imbalance(),
    output::allowed_imbalance_of_damage(crack.record().mean_speed() * sheet.automatic_step / sheet.law.length,
                                        motion.time() / sheet.automatic_step)));
  return end_crack(input, options, run, results, measurement);
}

} // namespace latcon::commands
