#include "lattice/velocity_verlet.h"

#include <stdexcept>

#include "lattice/instruction_sets.h"

namespace lattice
{
namespace
{

// Rows are shared out among threads; nothing here couples two sites, so the bits cannot depend on how.
template <class RowOperation>
void for_each_row(const TriangularLattice &lattice, const RowOperation &operation)
{
  const auto n_rows = static_cast<std::ptrdiff_t>(lattice.rows());
#pragma omp parallel for schedule(static) if (lattice.n_places() >= worth_threads)
  for (std::ptrdiff_t row = 0; row < n_rows; ++row)
  {
    const std::size_t first = lattice.index(static_cast<std::size_t>(row), 0);
    operation(first, first + lattice.columns());
  }
}

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
  : lattice_(lattice), forces_(forces), time_step_(time_step), predicted_vx_(lattice.n_places(), 0.),
    predicted_vy_(lattice.n_places(), 0.)
{
  if (!(time_step > 0.))
    throw std::invalid_argument("velocity Verlet needs a positive time step");
}

void VelocityVerlet::initialise(State &state)
{
  update_images(state, lattice_);
  predicted_vx_ = state.vx;
  predicted_vy_ = state.vy;
  evaluate(state);
  update_accelerations(state);
}

void VelocityVerlet::evaluate(State &state)
{
  forces_.evaluate(state, predicted_vx_, predicted_vy_);
  for (SiteForces *forces : site_forces_)
    forces->evaluate(state, predicted_vx_, predicted_vy_);
}

void VelocityVerlet::add_site_forces(State &state, double duration) const
{
  for (const SiteForces *forces : site_forces_)
    for (const auto &[place, force] : forces->last())
    {
      const Eigen::Vector2d acceleration = state.inverse_mass[place] * force;
      state.ax[place] += acceleration.x();
      state.ay[place] += acceleration.y();
      state.vx[place] += duration * acceleration.x();
      state.vy[place] += duration * acceleration.y();
    }
}

void VelocityVerlet::update_accelerations(State &state) const
{
  for_each_row(lattice_,
               [&](std::size_t begin, std::size_t end)
               {
                 for (std::size_t i = begin; i < end; ++i)
                 {
                   state.ax[i] = forces_.fx()[i] * state.inverse_mass[i];
                   state.ay[i] = forces_.fy()[i] * state.inverse_mass[i];
                 }
               });
  add_site_forces(state, 0.);
}

void VelocityVerlet::step(State &state)
{
  const double h = time_step_;
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
  evaluate(state);
  for_each_row(
    lattice_,
    [&](std::size_t begin, std::size_t end)
    {
      kick(h, end - begin, &forces_.fx()[begin], &state.inverse_mass[begin], &state.ax[begin], &state.vx[begin]);
      kick(h, end - begin, &forces_.fy()[begin], &state.inverse_mass[begin], &state.ay[begin], &state.vy[begin]);
    });
  add_site_forces(state, 0.5 * h);
  update_images(state, lattice_);
  state.time += h;
}

} // namespace lattice
