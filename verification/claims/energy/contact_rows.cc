#include "verification/claims/energy/contact_rows.h"

#include <cmath>

#include "lattice/simulation.h"
#include "support/largest_error.h"
#include "verification/claims/absolute_modulus.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{
namespace
{

// Steps in the duration of a contact: its end falls anywhere into a step, where the force has a kink.
constexpr double steps = 400.;

// Theory.md, eq. (L.13), from the constants of the case.
struct Impact
{
  double duration, restitution; // [s], [-]

  Impact(const bridge::Subject &subject, const input::Case &input)
  {
    const double pitch = std::sqrt(3.) / 2., d = subject.spacing;
    const lattice::Shell &nearest = subject.material.nearest;
    const double reduced_mass = 0.5 * subject.material.density * pitch * d * d;
    const double section = nearest.area_factor * pitch; // over d
    const double omega_0 = std::sqrt(input.contact_stiffness * section * stiffness_at_rest(nearest.law) / reduced_mass);
    const double beta = 0.5 * input.contact_viscosity * section * nearest.viscosity / reduced_mass;
    const double square = omega_0 * omega_0 - beta * beta, rate = std::sqrt(std::abs(square));
    duration = square > 0. ? std::atan2(2. * beta * rate, beta * beta - square) / rate
                           : std::log((beta + rate) / (beta - rate)) / rate;
    restitution = std::exp(-beta * duration);
  }
};

} // namespace

output::Results contact_rows(const bridge::Subject &subject, const input::Case &input,
                             const std::function<void(lattice::ContactLaw &)> &planted)
{
  const double d = subject.spacing;
  const lattice::TriangularLattice sheet = subject.sheet();
  const lattice::Material material = lattice::without_memory(subject.material);
  lattice::ContactLaw law = lattice::contact_like_nearest_bond(sheet, material, input.contact_distance * d,
                                                               input.contact_stiffness, input.contact_viscosity);
  if (planted)
    planted(law);
  const Impact impact(subject, input);

  // Two sites without bonds, in touch, along no line of the lattice.
  const Eigen::Vector2d direction(0.8, 0.6);
  const std::size_t left = sheet.index(sheet.rows() / 2, sheet.sites_in_row(0) / 2), right = left + 1;
  lattice::State state = lattice::homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), lattice::Edges::free);
  const double inverse_mass = state.inverse_mass[left];
  state.bonds.clear(sheet.n_places());
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    const bool stays = place == left || place == right;
    state.removed[place] = sheet.is_site(place) && !stays ? 1 : 0;
    state.inverse_mass[place] = stays ? inverse_mass : 0.;
    state.lost_bonds[place] = stays ? 1 : 0;
  }
  // So slow that they overlap by a thousandth of the distance at most.
  const double speed = 1e-3 * law.distance / impact.duration;
  const Eigen::Vector2d common = 2. * speed * Eigen::Vector2d(direction.y(), -0.3);
  state.x[right] = state.x[left] + law.distance * (1. - 1e-12) * direction.x();
  state.y[right] = state.y[left] + law.distance * (1. - 1e-12) * direction.y();
  for (const auto &[place, sign] : {std::pair(left, 0.5), std::pair(right, -0.5)})
  {
    state.vx[place] = common.x() + sign * speed * direction.x();
    state.vy[place] = common.y() + sign * speed * direction.y();
  }
  lattice::TimeStepping stepping = input.fracture_time_stepping();
  stepping.step = support::smallest_of({stepping.step, impact.duration / steps});
  lattice::Simulation simulation(sheet, material, std::move(state), stepping);
  simulation.enable_contact(law);
  while (simulation.state().time < 1.5 * impact.duration)
    simulation.step();

  const auto velocity = [&](std::size_t place)
  { return Eigen::Vector2d(simulation.state().vx[place], simulation.state().vy[place]); };
  const double restitution = (velocity(right) - velocity(left)).dot(direction) / speed;
  const double momentum = (0.5 * (velocity(right) + velocity(left)) - common).norm() / speed;
  const lattice::EnergyBalance energies = simulation.energies();
  output::Results results;
  const Rows rows(results, "energy",
                  subject.name + ": contact of two sites" +
                    (stepping.stages > 0 ? " (Runge-Kutta-Chebyshev), " : ", "));
  rows.add(
    "coefficient of restitution against bonds and contact alone", "1", of_lattice(restitution, impact.restitution),
    support::relative_error(restitution, impact.restitution),
    {3e-4,
     "second order of 400 steps in the contact, and the kink of the force at its end: 1e-4 at most, times three"});
  rows.add("momentum, change over that of approach", "1", of_lattice(momentum, 0.), momentum, {1e-10, "round-off"});
  const double imbalance = energies.imbalance() / energies.initial;
  rows.add("energy imbalance over the energy at the start", "1", of_lattice(imbalance, 0.), std::abs(imbalance),
           {1e-4, "time stepping while they touch: (w h)^2 / 4 with 400 steps, 6e-5"});
  return results;
}

} // namespace latcon::claims
