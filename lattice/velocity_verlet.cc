#include "lattice/velocity_verlet.h"

#include <functional>

#include "lattice/row_kernels.h"

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
    const std::size_t begin = lattice_.index(row, 0), n = lattice_.columns();
    kernels::loops().drift(time_step(), n, &state.ax[begin], &state.vx[begin], &state.x[begin], &predicted_vx_[begin]);
    kernels::loops().drift(time_step(), n, &state.ay[begin], &state.vy[begin], &state.y[begin], &predicted_vy_[begin]);
  };
  const auto kick_row = [&](std::size_t row, const double *fx, const double *fy)
  { kick(state, row, fx, fy, 0.5 * time_step()); };
  forces_.set_elapsed(time_step());
  Forces::RowCallbacks work = move_rows(state, drift);
  work.fields = {&state.x, &state.y, &state.vx, &state.vy, &state.ax, &state.ay, &predicted_vx_, &predicted_vy_};
  work.post_force = std::ref(kick_row);
  work.history = &state.history;
  forces_.evaluate(state, predicted_vx_, predicted_vy_, work);
  evaluate_site_forces(state);
  accelerate_sites(state);
  kick_sites(state, 0.5 * time_step());
  update_images(state, band_);
  state.time += time_step();
}

} // namespace latcon::lattice
