#include "verification/commands/command.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <omp.h>

#include "support/errors.h"
#include "support/text_wrap.h"
#include "verification/bridge/lattice_sheet.h"

namespace latcon::commands
{
namespace
{

// Estimated time above which a run is refused unless the user confirms it by `--yes` [s].
constexpr double longest_run = 10. * 86400.;
// Cost of a reduced frame over that of one with all fields, in time and on disk.
constexpr double cost_of_motion_frame = 0.1;
// Of a compressed frame with all fields; 373 and 386 at the start and the end of a crack through 3024 sites.
constexpr double bytes_of_site_on_disk = 380.;

std::string seconds_text(double seconds)
{
  return support::text_of(std::ceil(seconds), " s");
}

// Output of `--dry-run` without memory; the sheet must fit into the memory. Collective.
// @param claims, report whether claims are checked before the crack, and its page is drawn afterwards
std::string lattice_text(const input::Case &input, const lattice::TimeStepping &stepping, const resources::RunKind run,
                         const bool claims, const bool report)
{
  const lattice::TriangularLattice sheet = input.sheet();
  const lattice::State state = bridge::lattice_state(input, sheet);
  std::size_t sites = 0;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    sites += sheet.is_site(place) && state.removed[place] == 0;
  std::size_t bonds = 0;
  lattice::for_each_bond(state, sheet, [&](const lattice::Bond &) { ++bonds; });
  std::ostringstream out;
  out << (sheet.is_triangular() ? "# lattice: " : "# nonlocal continuum: ") << sites << " sites, " << bonds
      << " bonds, " << 2 * sites << " unknowns, " << sheet.length() << " m x " << sheet.height() << " m\n";
  double steps = 0., parts = 1.;
  double frames = 2.;  // the first and the last
  double at_most = 1.; // maximum number of steps over the expected one
  const auto frames_in = [&](double n)
  { return input.frame_interval > 0. ? std::min(n, std::floor(n * stepping.step / input.frame_interval)) : 0.; };
  if (run != resources::RunKind::equilibrium)
  {
    steps = std::ceil(input.end_time / stepping.step);
    out << "# time step: " << stepping.step << " s, " << steps << " steps at most"
        << (stepping.stages > 0 ? " of " + std::to_string(stepping.stages) + " stages each" : "");
    if (run == resources::RunKind::fracture)
    {
      at_most = steps;
      steps = resources::expected_steps(input, stepping);
      at_most /= steps;
      out << ", " << steps << " if the crack is as fast as shear waves of the unloaded sheet";
    }
    out << "\n";
    frames += frames_in(steps);
    parts = resources::parts_of_first_step(input, stepping, run);
    if (parts > 1.)
      out << "# bonds of the loaded sheet are so short that the first step is made in " << parts
          << " parts; the time below is that of all steps likewise\n";
    if (run == resources::RunKind::fracture)
      frames += cost_of_motion_frame * input.motion_frames;
  }
  const double seconds = resources::lattice_seconds(input, stepping, run, steps * parts, frames);
  out << "# time: about " << seconds_text(seconds) << " on " << omp_get_max_threads() << " threads of each rank";
  if (at_most > 1.)
    out << ", at most " << seconds_text(at_most * seconds) << " if the crack is slower or does not run";
  if (claims)
    out << ", and " << seconds_text(resources::seconds_of_claims)
        << " for the claims, unless their verdicts are stored";
  if (report)
    out << ", and " << seconds_text(resources::seconds_of_report) << " for pictures and page";
  const double bytes = bytes_of_site_on_disk * static_cast<double>(sites);
  out << "\n# disk: about " << frames * bytes << " bytes for frames";
  if (at_most > 1.)
    out << ", at most " << (frames + frames_in(std::round(at_most * steps)) - frames_in(steps)) * bytes << " bytes";
  out << "\n";
  return out.str();
}

} // namespace

void require_time(const input::Options &options, const double seconds)
{
  if (options.yes || !(seconds > longest_run))
    return;
  std::ostringstream text;
  text.precision(2);
  text << "the run would take about " << seconds / 86400. << " days, more than " << longest_run / 86400.
       << "; make the sheet smaller or coarser, the motion shorter, or use more cores; use --yes to run it anyway";
  throw support::InputError(text.str());
}

bool is_to_be_run(const input::Options &options, const input::Parameters &parameters, const input::Case &input,
                  const lattice::TimeStepping &stepping, const resources::RunKind run)
{
  const bool breaks = run == resources::RunKind::fracture, claims = breaks && !options.skip_verification;
  const resources::MemoryNeed memory = resources::lattice_memory(input, run, claims);
  if (options.dry_run)
    print_dry_run(options, parameters.resolved_text() + resources::memory_text(memory));
  if (!options.yes)
    resources::require_memory(memory);
  if (options.dry_run && !options.quiet)
    print_dry_run(options, lattice_text(input, stepping, run, claims, breaks && !options.no_report));
  if (run != resources::RunKind::equilibrium)
    require_time(options, resources::lattice_seconds(
                            input, stepping, run,
                            breaks ? resources::expected_steps(input, stepping) : input.end_time / stepping.step, 0.));
  return !options.dry_run;
}

} // namespace latcon::commands
