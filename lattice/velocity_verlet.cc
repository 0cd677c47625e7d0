#include "lattice/velocity_verlet.h"

#include <algorithm>

#include "lattice/row_kernels.h"

namespace latcon::lattice
{

VelocityVerlet::VelocityVerlet(const RowPartition &band, Forces &forces, double time_step)
  : Integrator(band, forces, time_step), predicted_vx_(lattice_.n_places()), predicted_vy_(lattice_.n_places())
{
}

std::vector<Field *> VelocityVerlet::evaluated_fields(State &state)
{
  return {&state.x, &state.y, &predicted_vx_, &predicted_vy_};
}

void VelocityVerlet::initialise(State &state)
{
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

void VelocityVerlet::drift(State &state, std::size_t row)
{
  const std::size_t begin = lattice_.index(row, 0), n = lattice_.columns();
  kernels::loops().drift(time_step(), n, &state.ax[begin], &state.vx[begin], &state.x[begin], &predicted_vx_[begin]);
  kernels::loops().drift(time_step(), n, &state.ay[begin], &state.vy[begin], &state.y[begin], &predicted_vy_[begin]);
}

void VelocityVerlet::step(State &state)
{
  const auto drift_row = [&](std::size_t row) { drift(state, row); };
  const auto after = [&](std::size_t row, const double *fx, const double *fy)
  { kick(state, row, fx, fy, 0.5 * time_step()); };
  forces_.set_elapsed(time_step());
  const Rows own = band_.rows(), interior = halo_.interior();
  for_each_row(lattice_, {own.begin, interior.begin}, drift_row);
  for_each_row(lattice_, {interior.end, own.end}, drift_row);
  halo_.start(evaluated_fields(state));
  // Forces on the rows next to the halo apart from the others would take longer than waiting for it.
  if (lattice_.images().empty())
  {
    const auto before = [&](std::size_t row)
    {
      if (row >= interior.begin && row < interior.end)
        drift(state, row);
    };
    halo_.finish();
    touched_ = {&state.x, &state.y, &state.vx, &state.vy, &state.ax, &state.ay, &predicted_vx_, &predicted_vy_};
    forces_.evaluate(state, predicted_vx_, predicted_vy_,
                     {std::ref(before), &touched_, std::ref(after), &state.history});
  }
  else
  {
    for_each_row(lattice_, interior, drift_row);
    halo_.finish();
    update_all_images(state);
    forces_.evaluate(state, predicted_vx_, predicted_vy_, {{}, nullptr, std::ref(after), &state.history});
  }
  evaluate_site_forces(state);
  accelerate_sites(state);
  kick_sites(state, 0.5 * time_step());
  update_images(state, band_);
  state.time += time_step();
}

} // namespace latcon::lattice
