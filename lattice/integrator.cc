#include "lattice/integrator.h"

#include <algorithm>
#include <functional>
#include <set>

#include "support/require.h"

namespace latcon::lattice
{

Integrator::Integrator(const RowPartition &band, Forces &forces, double time_step)
  : band_(band), lattice_(band.lattice()), forces_(forces), sent_(band.halo_sites(true)),
    received_(band.halo_sites(false)), time_step_(time_step)
{
  support::require(time_step > 0., "time stepping needs a positive time step");
}

void Integrator::find_rollers(const State &state)
{
  rollers_.clear();
  for (const std::size_t place : lattice_.sites(band_.rows()))
    for (const std::size_t axis : axes)
      if ((state.rollers[place] >> axis & 1) != 0)
        rollers_.push_back({place, axis, state.velocity[axis][place]});
}

void Integrator::initialise(State &state)
{
  find_rollers(state);
  for (const std::size_t place : lattice_.sites(band_.rows()))
    evaluated(state).set(place, state.velocity.at(place));
  exchange_ghosts(state);
  accelerate(state);
}

void Integrator::exchange_ghosts(State &state)
{
  VectorField &velocity = evaluated(state);
  band_.exchange(sent_, received_, {&state.position.x, &state.position.y, &velocity.x, &velocity.y});
  update_images(state, band_);
  for (const TriangularLattice::Image &image : lattice_.images())
    if (band_.is_relevant(image.site))
      velocity.set(image.place, velocity.at(image.site));
}

// Threads may still read the velocities of rows next to theirs, so that only accelerations are written.
void Integrator::accelerate_row(State &state, std::size_t row, const Forces::OfRow &force) const
{
  const std::size_t begin = lattice_.index(row, 0);
  for (const std::size_t axis : axes)
    std::transform(force[axis], force[axis] + lattice_.columns(), &state.inverse_mass[begin],
                   &state.acceleration[axis][begin], std::multiplies());
}

void Integrator::accelerate(State &state, double lookahead)
{
  const auto after = [&](std::size_t row, const Forces::OfRow &force) { accelerate_row(state, row, force); };
  evaluate(state, std::ref(after), &state.history, lookahead);
  accelerate_sites(state);
}

void Integrator::evaluate(State &state, const Forces::RowFunction &post_force, BondHistory *history, double lookahead)
{
  forces_.evaluate(state, evaluated(state), post_force, history, lookahead, [&] { evaluate_site_forces(state); });
}

void Integrator::evaluate_site_forces(State &state)
{
  for (SiteForces *forces : site_forces_)
    forces->evaluate(state, evaluated(state));
}

void Integrator::accelerate_sites(State &state)
{
  of_bonds_.clear();
  for (const SiteForces *forces : site_forces_)
    for (const auto &[place, force] : forces->last())
    {
      of_bonds_.emplace_back(place, state.acceleration.at(place));
      state.acceleration.add(place, state.inverse_mass[place] * force);
    }
  for (const RollerVelocity &roller : rollers_)
    state.acceleration[roller.axis][roller.place] = 0.;
}

void Integrator::kick_sites(State &state, double duration) const
{
  for (const SiteForces *forces : site_forces_)
    for (const auto &[place, force] : forces->last())
      state.velocity.add(place, duration * (state.inverse_mass[place] * force));
  for (const RollerVelocity &roller : rollers_)
    state.velocity[roller.axis][roller.place] = roller.velocity;
}

void Integrator::update_accelerations(State &state, const std::vector<BrokenBond> &broken)
{
  // Where several forces act on a site, the first of these is what bonds alone give.
  for (auto site = of_bonds_.rbegin(); site != of_bonds_.rend(); ++site)
    state.acceleration.set(site->first, site->second);
  std::set<std::size_t> rows;
  for (const BrokenBond &bond : broken)
    for (const std::size_t place : {bond.near, bond.far})
      if (band_.owns(place))
        rows.insert(lattice_.row_of(place));
  for (const std::size_t row : rows)
    forces_.evaluate_row(state, evaluated(state), row,
                         [&](std::size_t, const Forces::OfRow &force) { accelerate_row(state, row, force); });
  accelerate_sites(state);
}

} // namespace latcon::lattice
