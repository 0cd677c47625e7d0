#include <functional>

#include "lattice/integrator.h"

namespace latcon::lattice
{

RungeKuttaChebyshev::RungeKuttaChebyshev(const RowPartition &band, Forces &forces, double time_step,
                                         unsigned int stages)
  : Integrator(band, forces, time_step), stages_(stages), damping_limit_(stages_.real_limit() / time_step)
{
  for (Motion *motion : {&start_, &previous_})
    *motion = {VectorField(lattice_.n_places()), VectorField(lattice_.n_places())};
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
  const auto swap_with_previous = [&]
  {
    std::swap(state.position, previous_.position);
    std::swap(state.velocity, previous_.velocity);
  };
  // The fields of the state stay where they are in memory: views of them remain valid.
  const bool is_odd = stages_.stages().size() % 2 == 1;
  if (is_odd)
    swap_with_previous();
  const VectorField &x = is_odd ? previous_.position : state.position,
                    &v = is_odd ? previous_.velocity : state.velocity;
  const auto first_stage = [&](std::size_t row)
  {
    const std::size_t i = lattice_.index(row, 0);
    for (const std::size_t axis : axes)
      kernels::loops().first_stage(h * stages_.first(), lattice_.columns(), &state.acceleration[axis][i], &x[axis][i],
                                   &v[axis][i], &state.position[axis][i], &state.velocity[axis][i],
                                   &start_.position[axis][i], &start_.velocity[axis][i], &previous_.position[axis][i],
                                   &previous_.velocity[axis][i]);
  };
  for_each_row(lattice_, band_.rows(), first_stage);
  exchange_ghosts(state);
  for (const ChebyshevStages::Stage &stage : stages_.stages())
  {
    const auto next = [&](std::size_t row, const Forces::OfRow &force)
    {
      const std::size_t i = lattice_.index(row, 0);
      for (const std::size_t axis : axes)
        kernels::loops().next_stage(stage, h, lattice_.columns(), force[axis], &state.inverse_mass[i],
                                    &state.acceleration[axis][i], &start_.position[axis][i], &start_.velocity[axis][i],
                                    &state.position[axis][i], &state.velocity[axis][i], &previous_.position[axis][i],
                                    &previous_.velocity[axis][i]);
    };
    forces_.set_elapsed(stage.elapsed * h);
    evaluate(state, std::ref(next));
    swap_with_previous();
    kick_sites(state, h * stage.now);
    exchange_ghosts(state);
  }
  forces_.set_elapsed(h);
  accelerate(state, 0.5 * h);
  state.time += h;
}

} // namespace latcon::lattice
