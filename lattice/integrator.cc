#include "lattice/integrator.h"

#include <algorithm>
#include <functional>

#include "support/require.h"

namespace latcon::lattice
{

Integrator::Integrator(const RowPartition &band, Forces &forces, double time_step)
  : band_(band), lattice_(band.lattice()), forces_(forces), sent_(band.halo_sites(true)),
    received_(band.halo_sites(false)), interior_(band.rows()), time_step_(time_step)
{
  support::require(time_step > 0., "time stepping needs a positive time step");
  const std::size_t reach = band.is_shared() ? lattice_.reach() : 0;
  interior_.begin = std::min(interior_.begin + reach, interior_.end);
  interior_.end -= std::min(reach, interior_.end - interior_.begin);
}

std::vector<Field *> Integrator::evaluated_fields(State &state)
{
  const bool predicts = !predicted_vx_.empty();
  return {&state.x, &state.y, predicts ? &predicted_vx_ : &state.vx, predicts ? &predicted_vy_ : &state.vy};
}

void Integrator::find_rollers(const State &state)
{
  rollers_.clear();
  for (std::size_t row = band_.rows().begin; row < band_.rows().end; ++row)
    for (std::size_t place = lattice_.index(row, 0); place < lattice_.index(row, lattice_.sites_in_row(row)); ++place)
      for (const unsigned int component : {0u, 1u})
        if ((state.rollers[place] >> component & 1) != 0)
          rollers_.push_back({place, component, (component == 0 ? state.vx : state.vy)[place]});
}

void Integrator::initialise(State &state)
{
  find_rollers(state);
  if (!predicted_vx_.empty())
    for_each_row(lattice_, band_.rows(),
                 [&](std::size_t row)
                 {
                   const std::size_t first = lattice_.index(row, 0), n = lattice_.columns();
                   std::copy_n(&state.vx[first], n, &predicted_vx_[first]);
                   std::copy_n(&state.vy[first], n, &predicted_vy_[first]);
                 });
  exchange_ghosts(state);
  accelerate(state);
}

Forces::RowCallbacks Integrator::move_rows(State &state, const std::function<void(std::size_t row)> &move)
{
  Forces::RowCallbacks work;
  for_each_row(lattice_, {band_.rows().begin, interior_.begin}, move);
  for_each_row(lattice_, {interior_.end, band_.rows().end}, move);
  if (lattice_.images().empty())
    work.pre_force = [this, &move](std::size_t row)
    {
      if (row >= interior_.begin && row < interior_.end)
        move(row);
    };
  else
    for_each_row(lattice_, interior_, move);
  exchange_ghosts(state);
  return work;
}

void Integrator::exchange_ghosts(State &state)
{
  const std::vector<Field *> fields = evaluated_fields(state);
  band_.exchange(sent_, received_, fields);
  update_images(state, band_);
  for (const TriangularLattice::Image &image : lattice_.images())
    if (band_.is_relevant(image.site))
      for (Field *velocity : {fields[2], fields[3]})
        (*velocity)[image.place] = (*velocity)[image.site];
}

void Integrator::accelerate(State &state)
{
  // Threads may still read the velocities of rows next to theirs, so that only accelerations are written.
  const auto after = [&](std::size_t row, const double *fx, const double *fy)
  {
    const std::size_t begin = lattice_.index(row, 0), n = lattice_.columns();
    std::transform(fx, fx + n, &state.inverse_mass[begin], &state.ax[begin], std::multiplies());
    std::transform(fy, fy + n, &state.inverse_mass[begin], &state.ay[begin], std::multiplies());
  };
  forces_.evaluate(state, evaluated_vx(state), evaluated_vy(state), {{}, {}, std::ref(after), &state.history});
  evaluate_site_forces(state);
  accelerate_sites(state);
}

void Integrator::evaluate_site_forces(State &state)
{
  const std::vector<Field *> fields = evaluated_fields(state);
  for (SiteForces *forces : site_forces_)
    forces->evaluate(state, *fields[2], *fields[3]);
}

void Integrator::accelerate_sites(State &state)
{
  of_bonds_.clear();
  for (const SiteForces *forces : site_forces_)
    for (const auto &[place, force] : forces->last())
    {
      of_bonds_.push_back({place, state.ax[place], state.ay[place]});
      state.ax[place] += state.inverse_mass[place] * force.x();
      state.ay[place] += state.inverse_mass[place] * force.y();
    }
  for (const RollerVelocity &roller : rollers_)
    (roller.component == 0 ? state.ax : state.ay)[roller.place] = 0.;
}

void Integrator::kick_sites(State &state, double duration) const
{
  for (const SiteForces *forces : site_forces_)
    for (const auto &[place, force] : forces->last())
    {
      state.vx[place] += duration * (state.inverse_mass[place] * force.x());
      state.vy[place] += duration * (state.inverse_mass[place] * force.y());
    }
  for (const RollerVelocity &roller : rollers_)
    (roller.component == 0 ? state.vx : state.vy)[roller.place] = roller.velocity;
}

void Integrator::update_accelerations(State &state, const std::vector<std::size_t> &places)
{
  // Where several forces act on a site, the first of these is what bonds alone give.
  for (auto site = of_bonds_.rbegin(); site != of_bonds_.rend(); ++site)
  {
    state.ax[site->place] = site->ax;
    state.ay[site->place] = site->ay;
  }
  for (const std::size_t place : places)
    if (band_.owns(place))
    {
      const Eigen::Vector2d force = forces_.on_site(state, evaluated_vx(state), evaluated_vy(state), place);
      state.ax[place] = force.x() * state.inverse_mass[place];
      state.ay[place] = force.y() * state.inverse_mass[place];
    }
  accelerate_sites(state);
}

} // namespace latcon::lattice
