#include "verification/claims/wave_speeds/wave_speeds_claim.h"

#include <cmath>

#include "lattice/end_loads.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{
namespace
{

constexpr double width = 8., distance = 6. * width; // of the pulse, and of the end from it [d]

// Integral of the displacement along a polarisation, after the pulse has met the right end, over that before.
double reflected_share(const bridge::Subject &subject, const Eigen::Vector2d &polarisation)
{
  const double d = subject.spacing;
  const Eigen::Matrix2d &F = subject.deformation;
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const lattice::TriangularLattice sheet(d, 2. * distance * d, 8. * d, subject.orientation, {false, true});
  const double speed =
    std::sqrt(polarisation.dot(lattice::tangent_along_x(sheet, material, F) * polarisation) / material.density);
  lattice::State state = lattice::homogeneous_state(sheet, material, F, {false, false, true, true});
  const lattice::State at_rest = state;
  lattice::Field vx(sheet.n_places(), 0.), vy(sheet.n_places(), 0.);
  const double amplitude = 1e-5 * width * d, middle = sheet.length() - distance * d;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    const double z = (sheet.reference(place).x() - middle) / (width * d);
    const double u = amplitude * std::exp(-0.5 * z * z), v = speed * z / (width * d) * u;
    state.x[place] += u * polarisation.x();
    state.y[place] += u * polarisation.y();
    vx[place] = v * polarisation.x();
    vy[place] = v * polarisation.y();
  }
  const auto integral = [&](const lattice::State &now)
  {
    double sum = 0.;
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      if (now.inverse_mass[place] > 0.)
        sum += polarisation.dot(Eigen::Vector2d(now.x[place] - at_rest.x[place], now.y[place] - at_rest.y[place]));
    return sum;
  };
  const double before = integral(state);
  lattice::Simulation simulation(
    sheet, material, std::move(state),
    0.9 * lattice::time_step_limits(sheet, material, 0.99 * smallest_stretch(sheet, F)).combined);
  simulation.load_ends(F, lattice::EndLoads::End::absorbing, lattice::EndLoads::End::absorbing);
  simulation.set_velocities(vx, vy);
  while (simulation.state().time < 2. * distance * d / speed)
    simulation.step();
  return integral(simulation.state()) / before;
}

} // namespace

output::Results absorbing_end_rows(const bridge::Subject &subject)
{
  output::Results results;
  const Rows rows(results, "wave-speeds",
                  subject.name + ", loaded: share of a long wave that an absorbing end reflects, ");
  const support::SymmetricModes waves =
    support::symmetric_modes(lattice::tangent_along_x(subject.sheet(), subject.material, subject.deformation));
  for (int i = 0; i < 2; ++i)
  {
    const double share = reflected_share(subject, waves.vectors.col(i));
    rows.add(i == 0 ? "slower wave" : "faster wave", "1", of_lattice(share, 0.), std::abs(share),
             {5e-4, "dispersion of the pulse, (kd)^2 / 24 at k = 1 / 8 d"});
  }
  return results;
}

} // namespace latcon::claims
