#include "verification/commands/crack_run.h"

#include <iostream>
#include <limits>
#include <sstream>

#include "support/largest_error.h"
#include "verification/commands/crack_summary.h"
#include "verification/commands/signals.h"

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
    const support::ExitCode drawn = draw_report(run.directory(), true, run.is_verbose());
    phase.stop();
    if (drawn != support::ExitCode::claim_failed)
      exit_code = drawn;
    if (run.is_verbose() && exit_code == support::ExitCode::done)
      std::cout << times_text(run.info().stopwatch().times()) << "; " << run.directory() << "/report.html" << std::endl;
  }
  MPI_Barrier(MPI_COMM_WORLD);
  return exit_code;
}

} // namespace

std::string crack_progress(const double time, const output::TipHistory &tip)
{
  std::ostringstream text;
  text.precision(3);
  text << ", t " << 1e3 * time << " ms, tip " << 100. * tip.X() << " cm, speed " << tip.speed() << " m/s";
  return text.str();
}

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
  output::Result energies{"fracture", "energy imbalance over energy exchanged", "1", {}, {}, {}, imbalance, allowed};
  energies.kind = output::RowKind::ledger;
  energies.*of_side = imbalance;
  results.add(energies);
  return results;
}

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

support::ExitCode end_crack(const input::Case &input, const input::Options &options, Run &run,
                            const output::Results &results, const analysis::CrackMeasurement &crack)
{
  const support::ExitCode exit_code =
    run.end(results, interrupted() ? support::ExitCode::interrupted : exit_code_of(results));
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

} // namespace latcon::commands
