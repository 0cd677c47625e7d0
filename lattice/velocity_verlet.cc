#include "lattice/velocity_verlet.h"

#include "lattice/instruction_sets.h"
#include "lattice/rows.h"

namespace lattice
{
namespace
{

// One component of n sites: their velocities at half a step, their positions and predicted velocities after it.
LATCON_PER_INSTRUCTION_SET void drift(double h, std::size_t n, const double *__restrict acceleration,
                                      double *__restrict velocity, double *__restrict position,
                                      double *__restrict predicted)
{
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i)
  {
    const double kick = 0.5 * h * acceleration[i];
    velocity[i] += kick;
    position[i] += h * velocity[i];
    predicted[i] = velocity[i] + kick;
  }
}

// And their accelerations and velocities from the forces at its end.
LATCON_PER_INSTRUCTION_SET void kick(double h, std::size_t n, const double *__restrict force,
                                     const double *__restrict inverse_mass, double *__restrict acceleration,
                                     double *__restrict velocity)
{
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i)
  {
    acceleration[i] = force[i] * inverse_mass[i];
    velocity[i] += 0.5 * h * acceleration[i];
  }
}

} // namespace

VelocityVerlet::VelocityVerlet(const TriangularLattice &lattice, Forces &forces, double time_step)
  : Integrator(lattice, forces, time_step), predicted_vx_(lattice.n_places(), 0.), predicted_vy_(lattice.n_places(), 0.)
{
}

void VelocityVerlet::initialise(State &state)
{
  update_images(state, lattice_);
  predicted_vx_ = state.vx;
  predicted_vy_ = state.vy;
  evaluate(state, predicted_vx_, predicted_vy_);
  update_accelerations(state);
}

void VelocityVerlet::step(State &state)
{
  const double h = time_step();
  for_each_row(lattice_,
               [&](std::size_t begin, std::size_t end)
               {
                 drift(h, end - begin, &state.ax[begin], &state.vx[begin], &state.x[begin], &predicted_vx_[begin]);
                 drift(h, end - begin, &state.ay[begin], &state.vy[begin], &state.y[begin], &predicted_vy_[begin]);
               });
  update_images(state, lattice_);
  for (const TriangularLattice::Image &image : lattice_.images())
  {
    predicted_vx_[image.place] = predicted_vx_[image.site];
    predicted_vy_[image.place] = predicted_vy_[image.site];
  }
  evaluate(state, predicted_vx_, predicted_vy_);
  for_each_row(
    lattice_,
    [&](std::size_t begin, std::size_t end)
    {
      kick(h, end - begin, &forces_.fx()[begin], &state.inverse_mass[begin], &state.ax[begin], &state.vx[begin]);
      kick(h, end - begin, &forces_.fy()[begin], &state.inverse_mass[begin], &state.ay[begin], &state.vy[begin]);
    });
  accelerate_sites(state);
  kick_sites(state, 0.5 * h);
  update_images(state, lattice_);
  state.time += h;
}

} // namespace lattice
