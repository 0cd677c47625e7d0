#include <functional>

#include "lattice/integrator.h"

namespace latcon::lattice
{

VelocityVerlet::VelocityVerlet(const RowPartition &band, Forces &forces, double time_step)
  : Integrator(band, forces, time_step)
{
  predicted_velocity_ = VectorField(lattice_.n_places());
}

void VelocityVerlet::step(State &state)
{
  // Positions and predicted velocities of a row at the end of a step, velocities half way.
  const auto drift = [&](std::size_t row)
  {
    const std::size_t i = lattice_.index(row, 0);
    for (const std::size_t axis : axes)
      kernels::loops().drift(time_step(), lattice_.columns(), &state.acceleration[axis][i], &state.velocity[axis][i],
                             &state.position[axis][i], &predicted_velocity_[axis][i]);
  };
  const auto kick = [&](std::size_t row, const Forces::OfRow &force)
  {
    const std::size_t i = lattice_.index(row, 0);
    for (const std::size_t axis : axes)
      kernels::loops().kick(0.5 * time_step(), lattice_.columns(), force[axis], &state.inverse_mass[i],
                            &state.acceleration[axis][i], &state.velocity[axis][i]);
  };
  forces_.set_elapsed(time_step());
  for_each_row(lattice_, band_.rows(), drift);
  exchange_ghosts(state);
  evaluate(state, std::ref(kick), &state.history);
  accelerate_sites(state);
  kick_sites(state, 0.5 * time_step());
  update_images(state, band_);
  state.time += time_step();
}

} // namespace latcon::lattice
