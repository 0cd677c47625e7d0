#include "verification/commands/dry_run.h"

#include <cmath>
#include <sstream>

#include <omp.h>

#include "verification/bridge/lattice_sheet.h"

namespace latcon::commands
{
namespace
{

// Cost of a reduced frame over that of one with all fields, in time and on disk.
constexpr double cost_of_motion_frame = 0.1;
// Of a compressed frame with all fields; 373 and 386 at the start and the end of a crack through 3024 sites.
constexpr double bytes_of_site_on_disk = 380.;

// Number of frames of a motion: the first, the last, and those in between.
double frames_of(const input::Case &input, double duration)
{
  return 2. + (input.frame_interval > 0. ? std::floor(duration / input.frame_interval) : 0.);
}

std::string seconds_text(double seconds)
{
  std::ostringstream text;
  text << std::ceil(seconds) << " s";
  return text.str();
}

} // namespace

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
  out << (sheet.is_triangular() ? "# lattice: " : "# nonlocal continuum: ") << sites << " sites, " << bonds << " bonds, " << 2 * sites << " unknowns, " << sheet.length()
      << " m x " << sheet.height() << " m\n";
  double steps = 0., frames = 2., at_most = 1.; // at_most: maximum number of steps over the expected one
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
    frames = frames_of(input, steps * stepping.step);
    if (const double parts = resources::parts_of_first_step(input, stepping, run); parts > 1.)
      out << "# bonds of the loaded sheet are so short that the first step is made in " << parts
          << " parts; the time below is that of all steps likewise\n";
    if (run == resources::RunKind::fracture)
      frames += cost_of_motion_frame * input.motion_frames;
  }
  const double seconds = resources::lattice_seconds(input, stepping, run, steps, frames);
  out << "# time: about " << seconds_text(seconds) << " on " << omp_get_max_threads() << " threads of each rank";
  if (at_most > 1.)
    out << ", at most " << seconds_text(at_most * seconds) << " if the crack is slower or does not run";
  if (claims)
    out << ", and " << seconds_text(resources::seconds_of_claims)
        << " for the claims, unless their verdicts are stored";
  if (report)
    out << ", and " << seconds_text(resources::seconds_of_report) << " for pictures and page";
  out << "\n# disk: about " << frames * bytes_of_site_on_disk * static_cast<double>(sites) << " bytes for frames\n";
  return out.str();
}

} // namespace latcon::commands
