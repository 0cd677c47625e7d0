#include <functional>

#include "lattice/integrator.h"

namespace latcon::lattice
{

RungeKuttaChebyshev::RungeKuttaChebyshev(const RowPartition &band, Forces &forces, double time_step,
                                         unsigned int stages)
  : Integrator(band, forces, time_step), stages_(stages), damping_limit_(stages_.real_limit() / time_step)
{
  for (Motion *motion : {&start_, &previous_})
    for (Field *field : {&motion->x, &motion->y, &motion->vx, &motion->vy})
      *field = Field(lattice_.n_places());
}

void RungeKuttaChebyshev::set_time_step(double time_step)
{
  if (time_step == this->time_step())
    return;
  Integrator::set_time_step(time_step);
  // Less a hair, so that the step at the start has its own number again.
  stages_ = ChebyshevStages(ChebyshevStages::needed((1. - 1e-9) * damping_limit_ * time_step));
}

void RungeKuttaChebyshev::step(State &state)
{
  const double h = time_step();
  const std::function<void(std::size_t)> first_stage = [&](std::size_t row)
  {
    const double duration = h * stages_.first();
    const std::size_t i = lattice_.index(row, 0), n = lattice_.columns();
    kernels::loops().first_stage(duration, n, &state.ax[i], &state.x[i], &state.vx[i], &start_.x[i], &start_.vx[i],
                                 &previous_.x[i], &previous_.vx[i]);
    kernels::loops().first_stage(duration, n, &state.ay[i], &state.y[i], &state.vy[i], &start_.y[i], &start_.vy[i],
                                 &previous_.y[i], &previous_.vy[i]);
  };
  Forces::RowCallbacks work = move_rows(state, first_stage);
  work.fields = {&state.x,  &state.y,   &state.vx,  &state.vy,    &state.ax,    &state.ay,     &start_.x,
                 &start_.y, &start_.vx, &start_.vy, &previous_.x, &previous_.y, &previous_.vx, &previous_.vy};
  for (const ChebyshevStages::Stage &stage : stages_.stages())
  {
    const auto next = [&](std::size_t row, const double *fx, const double *fy)
    {
      const std::size_t i = lattice_.index(row, 0), n = lattice_.columns();
      const double *const inverse_mass = &state.inverse_mass[i];
      kernels::loops().next_stage(stage, h, n, fx, inverse_mass, &state.ax[i], &start_.x[i], &start_.vx[i], &state.x[i],
                                  &state.vx[i], &previous_.x[i], &previous_.vx[i]);
      kernels::loops().next_stage(stage, h, n, fy, inverse_mass, &state.ay[i], &start_.y[i], &start_.vy[i], &state.y[i],
                                  &state.vy[i], &previous_.y[i], &previous_.vy[i]);
    };
    forces_.set_elapsed(stage.elapsed * h);
    work.post_force = std::ref(next);
    forces_.evaluate(state, state.vx, state.vy, work);
    work.pre_force = nullptr;
    evaluate_site_forces(state);
    state.x.swap(previous_.x);
    state.y.swap(previous_.y);
    state.vx.swap(previous_.vx);
    state.vy.swap(previous_.vy);
    kick_sites(state, h * stage.now);
    exchange_ghosts(state);
  }
  forces_.set_elapsed(h);
  accelerate(state);
  state.time += h;
}

} // namespace latcon::lattice
