#include "lattice/runge_kutta_chebyshev.h"

#include "lattice/instruction_sets.h"
#include "lattice/rows.h"

namespace lattice
{
namespace
{

// One component of n sites: the first stage, in place, and what the further stages need of the start.
LATCON_PER_INSTRUCTION_SET void first_stage(double duration, std::size_t n, const double *__restrict acceleration,
                                            double *__restrict position, double *__restrict velocity,
                                            double *__restrict start_position, double *__restrict start_velocity,
                                            double *__restrict previous_position, double *__restrict previous_velocity)
{
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i)
  {
    const double x = position[i], v = velocity[i];
    start_position[i] = previous_position[i] = x;
    start_velocity[i] = previous_velocity[i] = v;
    position[i] = x + duration * v;
    velocity[i] = v + duration * acceleration[i];
  }
}

// And a further one, which takes the place of the stage before the last. Written in differences from the start, so that
// what stands still or flies straight does so to the last bit.
LATCON_PER_INSTRUCTION_SET void next_stage(const ChebyshevStages::Stage stage, double h, std::size_t n,
                                           const double *__restrict force, const double *__restrict inverse_mass,
                                           const double *__restrict start_acceleration,
                                           const double *__restrict start_position,
                                           const double *__restrict start_velocity, const double *__restrict position,
                                           const double *__restrict velocity, double *__restrict previous_position,
                                           double *__restrict previous_velocity)
{
  const double mu = stage.mu, nu = stage.nu, now = h * stage.now, start = h * stage.start;
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i)
  {
    const double x = start_position[i], v = start_velocity[i];
    previous_position[i] =
      x + (mu * (position[i] - x) + nu * (previous_position[i] - x)) + (now * velocity[i] + start * v);
    previous_velocity[i] = v + (mu * (velocity[i] - v) + nu * (previous_velocity[i] - v)) +
                           (now * (force[i] * inverse_mass[i]) + start * start_acceleration[i]);
  }
}

} // namespace

RungeKuttaChebyshev::RungeKuttaChebyshev(const TriangularLattice &lattice, Forces &forces, double time_step,
                                         unsigned int stages)
  : Integrator(lattice, forces, time_step), stages_(stages)
{
}

void RungeKuttaChebyshev::initialise(State &state)
{
  update_images(state, lattice_);
  // Stages come to stand in these: with the margin as it is.
  previous_ = {state.x, state.y, state.vx, state.vy};
  start_ = previous_;
  evaluate(state, state.vx, state.vy);
  update_accelerations(state);
}

void RungeKuttaChebyshev::step(State &state)
{
  const double h = time_step();
  for_each_row(lattice_,
               [&](std::size_t begin, std::size_t end)
               {
                 const double duration = h * stages_.first();
                 first_stage(duration, end - begin, &state.ax[begin], &state.x[begin], &state.vx[begin],
                             &start_.x[begin], &start_.vx[begin], &previous_.x[begin], &previous_.vx[begin]);
                 first_stage(duration, end - begin, &state.ay[begin], &state.y[begin], &state.vy[begin],
                             &start_.y[begin], &start_.vy[begin], &previous_.y[begin], &previous_.vy[begin]);
               });
  update_images(state, lattice_);
  for (const ChebyshevStages::Stage &stage : stages_.stages())
  {
    evaluate(state, state.vx, state.vy);
    for_each_row(
      lattice_,
      [&](std::size_t begin, std::size_t end)
      {
        const std::size_t n = end - begin;
        const double *const inverse_mass = &state.inverse_mass[begin];
        next_stage(stage, h, n, &forces_.fx()[begin], inverse_mass, &state.ax[begin], &start_.x[begin],
                   &start_.vx[begin], &state.x[begin], &state.vx[begin], &previous_.x[begin], &previous_.vx[begin]);
        next_stage(stage, h, n, &forces_.fy()[begin], inverse_mass, &state.ay[begin], &start_.y[begin],
                   &start_.vy[begin], &state.y[begin], &state.vy[begin], &previous_.y[begin], &previous_.vy[begin]);
      });
    state.x.swap(previous_.x);
    state.y.swap(previous_.y);
    state.vx.swap(previous_.vx);
    state.vy.swap(previous_.vy);
    kick_sites(state, h * stage.now);
    update_images(state, lattice_);
  }
  evaluate(state, state.vx, state.vy);
  update_accelerations(state);
  state.time += h;
}

} // namespace lattice
