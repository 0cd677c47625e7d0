#include <functional>

#include "lattice/integrator.h"

namespace latcon::lattice
{

VelocityVerlet::VelocityVerlet(const RowPartition &band, Forces &forces, double time_step)
  : Integrator(band, forces, time_step)
{
  predicted_vx_ = predicted_vy_ = Field(lattice_.n_places());
}

void VelocityVerlet::step(State &state)
{
  // Positions and predicted velocities of a row at the end of a step, velocities half way.
  const std::function<void(std::size_t)> drift = [&](std::size_t row)
  {
    const std::size_t i = lattice_.index(row, 0), n = lattice_.columns();
    kernels::loops().drift(time_step(), n, &state.ax[i], &state.vx[i], &state.x[i], &predicted_vx_[i]);
    kernels::loops().drift(time_step(), n, &state.ay[i], &state.vy[i], &state.y[i], &predicted_vy_[i]);
  };
  const auto kick = [&](std::size_t row, const double *fx, const double *fy)
  {
    const std::size_t i = lattice_.index(row, 0), n = lattice_.columns();
    kernels::loops().kick(0.5 * time_step(), n, fx, &state.inverse_mass[i], &state.ax[i], &state.vx[i]);
    kernels::loops().kick(0.5 * time_step(), n, fy, &state.inverse_mass[i], &state.ay[i], &state.vy[i]);
  };
  forces_.set_elapsed(time_step());
  Forces::RowCallbacks work = move_rows(state, drift);
  work.fields = {&state.x, &state.y, &state.vx, &state.vy, &state.ax, &state.ay, &predicted_vx_, &predicted_vy_};
  work.post_force = std::ref(kick);
  work.history = &state.history;
  forces_.evaluate(state, predicted_vx_, predicted_vy_, work);
  evaluate_site_forces(state);
  accelerate_sites(state);
  kick_sites(state, 0.5 * time_step());
  update_images(state, band_);
  state.time += time_step();
}

} // namespace latcon::lattice
