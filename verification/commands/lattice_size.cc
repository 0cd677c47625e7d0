#include "verification/commands/lattice_size.h"

#include <cmath>
#include <sstream>

#include <omp.h>

#include "verification/lattice_sheet.h"

namespace verification
{
namespace
{

// Doubles a place in State, Forces and VelocityVerlet, those that RungeKuttaChebyshev has more of, and nanoseconds a
// site and evaluation on one core with AVX2.
constexpr double doubles_per_place = 18.;
constexpr double chebyshev_doubles_per_place = 6.;
constexpr double nanoseconds_per_site_evaluation = 15.;

} // namespace

std::string lattice_size(const Case &input, const lattice::TimeStepping &stepping)
{
  const lattice::TriangularLattice sheet = input.lattice();
  const double steps = std::ceil(input.end_time / stepping.step);
  const lattice::State state = lattice_state(input, sheet, 1.);
  std::size_t sites = 0;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    sites += sheet.is_site(place) && state.removed[place] == 0;
  std::size_t bonds = 0;
  lattice::for_each_bond(state, sheet, [&](std::size_t, std::size_t, std::size_t) { ++bonds; });
  const double doubles = doubles_per_place + (stepping.stages > 0 ? chebyshev_doubles_per_place : 0.);
  std::ostringstream out;
  out << "# lattice: " << sites << " sites, " << bonds << " bonds, " << sheet.length() << " m x " << sheet.height()
      << " m\n"
      << "# time step: " << stepping.step << " s, " << steps << " steps at most"
      << (stepping.stages > 0 ? " of " + std::to_string(stepping.stages) + " stages each\n" : "\n")
      << "# memory: about " << std::ceil(sheet.n_places() * doubles * 8e-6) << " MB beside the libraries\n"
      << "# time: about "
      << std::ceil(core_seconds(steps * stepping.evaluations() * static_cast<double>(sites)) / omp_get_max_threads())
      << " s on " << omp_get_max_threads() << " threads\n";
  return out.str();
}

double core_seconds(double site_evaluations)
{
  return site_evaluations * nanoseconds_per_site_evaluation * 1e-9;
}

} // namespace verification
