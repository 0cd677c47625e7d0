#include <algorithm>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "support/largest_error.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/command.h"
#include "verification/commands/motion.h"
#include "verification/output/near_tip_record.h"

namespace latcon::commands
{
namespace
{

// Draws pictures and page of a run, then prints the seconds of each phase and the path of the page. Collective: an
// exception on one rank would end the others while rank 0 draws. @return exit code of the drawing, on rank 0
support::ExitCode draw_page(Run &run)
{
  support::ExitCode exit_code = support::ExitCode::done;
  if (run.is_root())
  {
    auto phase = run.info().stopwatch().phase("report");
    const support::ExitCode drawn = draw_report(run.directory(), run.is_verbose());
    phase.reset();
    if (drawn != support::ExitCode::claim_failed)
      exit_code = drawn;
    if (run.is_verbose() && exit_code == support::ExitCode::done)
      std::cout << times_text(run.info().stopwatch().times()) << "; " << run.directory() << "/report.html" << std::endl;
  }
  MPI_Barrier(MPI_COMM_WORLD);
  return exit_code;
}

// Motion until the crack reaches the stop position or the time ends, and small frames of it for animations, at equal
// distances of the tip: a film.
class CrackMotion : public LatticeMotion
{
public:
  CrackMotion(const input::Case &input, lattice::Simulation &simulation, double seed_tip,
              output::Checkpoints &checkpoints, Run &run)
    : LatticeMotion(input, simulation, checkpoints, run), seed_tip_(seed_tip),
      stop_(input.stop_position * simulation.lattice().length()), near_tip_(input, simulation, seed_tip),
      film_(std::make_shared<output::FieldWriter>(simulation.lattice(), simulation.material(), run.directory(),
                                                  "motion", output::FrameFields::motion)),
      film_pitch_((stop_ - seed_tip) / std::max(1u, input.motion_frames)), next_of_film_(seed_tip + film_pitch_)
  {
  }
  output::NearTipRecord &near_tip() { return near_tip_; }

  // Adds the last frame to the film and waits until all are written. Collective.
  void end_film()
  {
    add_to_film();
    flush();
  }

private:
  bool is_complete() const override { return !(time() < input_.end_time && record_.tip().X() < stop_); }
  std::pair<std::string, double> progress() const override
  {
    std::ostringstream text;
    text.precision(3);
    text << ", t " << 1e3 * time() << " ms, tip " << 100. * record_.tip().X() << " cm, speed " << record_.tip().speed()
         << " m/s, " << simulation_.n_broken() << " bonds broken";
    return {text.str(), std::max((record_.tip().X() - seed_tip_) / (stop_ - seed_tip_), time() / input_.end_time)};
  }
  void start() override
  {
    LatticeMotion::start();
    add_to_film();
    pass(record_.tip().X());
  }
  void write_resumed() override
  {
    LatticeMotion::write_resumed();
    if (input_.motion_frames > 0 && run_.is_root())
      film_->write_collection();
  }
  void after_step(const std::vector<lattice::BrokenBond> &broken) override
  {
    record_.step(broken);
    near_tip_.step();
    if (record_.tip().X() < next_of_film_)
      return;
    add_to_film();
    pass(record_.tip().X());
  }
  void archive(output::CheckpointReader &archive) override { parts(archive); }
  void archive(output::CheckpointWriter &archive) override { parts(archive); }
  template <class Archive>
  void parts(Archive &archive)
  {
    LatticeMotion::archive(archive);
    archive("near_tip", near_tip_);
    archive("film/frames", *film_);
    if constexpr (Archive::loads)
      follow_record();
  }

  // Finds the frames of the film from the record of the crack. Throws std::invalid_argument if they are others.
  void follow_record()
  {
    std::vector<double> times{0.};
    for (const analysis::TipRecord &tip : record_.tip().records())
      if (tip.X >= next_of_film_)
      {
        if (tip.t > 0.)
          times.push_back(tip.t);
        pass(tip.X);
      }
    if (input_.motion_frames > 0)
      support::require(film_->times() == times, "`times` of frames do not match the record of the tip");
  }

  void pass(double tip_X)
  {
    while (tip_X >= next_of_film_)
      next_of_film_ += film_pitch_;
  }

  void add_to_film()
  {
    if (input_.motion_frames == 0)
      return;
    const lattice::State &whole = simulation_.gather();
    if (run_.is_root())
      writing_.add([frames = film_, state = std::make_shared<const lattice::State>(whole)]
                   { frames->add_frame(*state); });
  }

  double seed_tip_, stop_; // [m]
  output::NearTipRecord near_tip_;
  std::shared_ptr<output::FieldWriter> film_; // also of the tasks that are pending
  double film_pitch_;                         // advance of the tip between frames [m]
  double next_of_film_;                       // X of the tip at the next frame [m]
};

// Returns the rows `fracture` of a crack: its measured quantities beside the published ones, and its energies.
// @param imbalance output::LedgerCheck::imbalance() [-] @param allowed with which it holds
output::Results measured_results(const input::Case &input, const analysis::CrackMeasurement &crack,
                                 const double imbalance, const output::Tolerance &allowed)
{
  const auto of_side = input.nonlocal.is_used ? &output::Result::continuum : &output::Result::lattice;
  output::Results results;
  const auto add = [&](const std::string &quantity, const std::string &unit,
                       const std::optional<analysis::Measured> &measured, const std::optional<double> &published)
  {
    output::Result row{"fracture", quantity, unit, {}, {}, published, {}, {}};
    if (measured)
      row.*of_side = measured->value;
    if (published)
    {
      row.kind = output::RowKind::reference;
      row.tolerance = {input.reference_tolerance, "that of the case: Reference/tolerance"};
      // A published quantity that could not be measured does not agree.
      row.error =
        measured ? support::relative_error(measured->value, *published) : std::numeric_limits<double>::quiet_NaN();
    }
    results.add(row);
  };
  add("Lagrangian crack speed", "m/s", crack.speed_lagrangian, input.reference_speed);
  add("laboratory crack speed", "m/s", crack.speed_laboratory, {});
  add("wavelength, undeformed", "m", crack.wavelength, input.reference_wavelength);
  add("amplitude, undeformed", "m", crack.amplitude, input.reference_amplitude);
  results.add(ledger_row("fracture",
                         input.nonlocal.is_used ? claims::of_continuum(imbalance) : claims::of_lattice(imbalance),
                         imbalance, allowed));
  return results;
}

// Checks claims on the case's own material and pre-stretch, as require_verified(). A crack that they refuse leaves its
// page all the same.
output::Results passed_or_reported(const input::Case &input, const std::vector<claims::Claim> &claims,
                                   const bridge::Laws &laws, const input::Options &options, Run &run)
{
  try
  {
    return require_verified(input, claims, laws, run);
  }
  catch (const support::ClaimFailed &)
  {
    if (!options.no_report)
      try
      {
        draw_page(run);
      }
      catch (const support::OutputError &error) // the failed claims are the message that matters
      {
        std::cerr << "latcon: " << error.what() << std::endl;
      }
    throw;
  }
}

// Ends the run of a crack: writes its results, prints its summary, draws its page. Collective. @return the exit code of
// the command
support::ExitCode end_crack(const input::Case &input, const input::Options &options, Run &run,
                            const output::Results &results, const analysis::CrackMeasurement &crack)
{
  const support::ExitCode exit_code = run.end(results, exit_code_of(results));
  if (run.is_verbose())
  {
    if (options.verbose)
      results.print(std::cout);
    std::cout << crack_summary(input, crack, results) << std::flush;
  }
  if (options.no_report || exit_code == support::ExitCode::interrupted)
  {
    if (run.is_verbose())
      std::cout << times_text(run.info().stopwatch().times()) << "; " << run.directory() << std::endl;
    return exit_code;
  }
  // The verdict in the page is the one returned here; a crack without its page has failed.
  const support::ExitCode drawn = draw_page(run);
  return exit_code == support::ExitCode::done ? drawn : exit_code;
}

// Moves the sheet until the crack reaches the stop position or the time ends. Collective, with the same measurement and
// rows on every rank.
std::pair<analysis::CrackMeasurement, output::Results> run_crack(const input::Case &input,
                                                                 const lattice::TriangularLattice &sheet,
                                                                 bool skip_verification,
                                                                 output::Checkpoints &checkpoints, Run &run)
{
  const lattice::RowPartition band(sheet, MPI_COMM_WORLD);
  const std::unique_ptr<lattice::Simulation> cracked = input::cracked_sheet(input, band);
  lattice::Simulation &simulation = *cracked;

  const double seed_tip = input.seed_tip(sheet);
  CrackMotion motion(input, simulation, seed_tip, checkpoints, run);
  motion.go("fracture");
  run.info().add("divided_steps", simulation.n_divided_steps());
  motion.end_film();
  output::CrackRecord &record = motion.record();
  const analysis::CrackMeasurement crack = record.measure(seed_tip);
  record.write_measurement(run.directory(), crack, seed_tip, input, skip_verification);
  if (run.is_root())
    motion.near_tip().write(run.directory(), crack);
  return {crack, measured_results(
                   input, crack, record.imbalance(),
                   output::allowed_imbalance(
                     input.integrator, simulation.state().time / input.automatic().fracture_time_stepping().step, 2.))};
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
  if (!is_to_be_run(options, parameters, input, input.fracture_time_stepping(), resources::RunKind::fracture))
    return support::ExitCode::done;

  output::Checkpoints checkpoints(options, parameters, input,
                                  options.on_continuum ? "fracture --side continuum" : "fracture");
  Run run(options, &parameters, &checkpoints);
  if (options.on_continuum)
  {
    run.info().add("side", "continuum");
    run.info().add("grid_spacing_m", sheet.spacing());
    run.info().add("half_bonds", sheet.n_kinds());
  }
  run.info().add("skip_verification", options.skip_verification);
  output::Results results;
  if (!options.skip_verification)
    results = passed_or_reported(input, claims_before_fracture(input.material(), options.on_continuum),
                                 bridge::laws_of_lattice(), options, run);
  const auto [crack, rows] = run_crack(input, sheet, options.skip_verification, checkpoints, run);
  results.add(rows);
  return end_crack(input, options, run, results, crack);
}

} // namespace latcon::commands
