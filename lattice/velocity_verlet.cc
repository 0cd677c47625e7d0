#include "lattice/velocity_verlet.h"

#include <algorithm>
#include <stdexcept>

#include "lattice/instruction_sets.h"

namespace lattice
{
namespace
{

// Rows are shared out among threads; nothing here couples two sites, so the bits cannot depend on how.
template <class RowOperation>
void for_each_row(const TriangularLattice &lattice, Rows rows, const RowOperation &operation)
{
  const auto end = static_cast<std::ptrdiff_t>(rows.end);
#pragma omp parallel for schedule(static) if ((rows.end - rows.begin) * lattice.stride() >= worth_threads)
  for (auto row = static_cast<std::ptrdiff_t>(rows.begin); row < end; ++row)
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

VelocityVerlet::VelocityVerlet(const RowBand &band, Forces &forces, double time_step)
  : band_(band), lattice_(band.lattice()), halo_(band), forces_(forces), time_step_(time_step),
    predicted_vx_(lattice_.n_places()), predicted_vy_(lattice_.n_places())
{
  if (!(time_step > 0.))
    throw std::invalid_argument("velocity Verlet needs a positive time step");
}

void VelocityVerlet::initialise(State &state)
{
  for_each_row(lattice_, band_.rows(),
               [&](std::size_t begin, std::size_t end)
               {
                 std::copy(&state.vx[begin], &state.vx[end], &predicted_vx_[begin]);
                 std::copy(&state.vy[begin], &state.vy[end], &predicted_vy_[begin]);
               });
  halo_.start(evaluated_fields(state));
  halo_.finish();
  evaluate(state);
  update_accelerations(state);
}

std::vector<Field *> VelocityVerlet::evaluated_fields(State &state)
{
  return {&state.x, &state.y, &predicted_vx_, &predicted_vy_};
}

void VelocityVerlet::evaluate(State &state)
{
  update_images(state, band_);
  for (const TriangularLattice::Image &image : lattice_.images())
    if (band_.knows(image.site))
    {
      predicted_vx_[image.place] = predicted_vx_[image.site];
      predicted_vy_[image.place] = predicted_vy_[image.site];
    }
  forces_.evaluate(state, predicted_vx_, predicted_vy_);
  evaluate_site_forces(state);
}

void VelocityVerlet::evaluate_site_forces(State &state)
{
  for (SiteForces *forces : site_forces_)
  {
    band_.share(forces->sites_to_know(), evaluated_fields(state));
    forces->evaluate(state, predicted_vx_, predicted_vy_);
  }
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
  for_each_row(lattice_, band_.rows(),
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
  const auto drift_row = [&](std::size_t begin, std::size_t end)
  {
    drift(h, end - begin, &state.ax[begin], &state.vx[begin], &state.x[begin], &predicted_vx_[begin]);
    drift(h, end - begin, &state.ay[begin], &state.vy[begin], &state.y[begin], &predicted_vy_[begin]);
  };
  const Rows own = band_.rows(), interior = halo_.interior();
  for_each_row(lattice_, {own.begin, interior.begin}, drift_row);
  for_each_row(lattice_, {interior.end, own.end}, drift_row);
  halo_.start(evaluated_fields(state));
  for_each_row(lattice_, interior, drift_row);
  halo_.finish();
  evaluate(state);
  for_each_row(
    lattice_, own,
    [&](std::size_t begin, std::size_t end)
    {
      kick(h, end - begin, &forces_.fx()[begin], &state.inverse_mass[begin], &state.ax[begin], &state.vx[begin]);
      kick(h, end - begin, &forces_.fy()[begin], &state.inverse_mass[begin], &state.ay[begin], &state.vy[begin]);
    });
  add_site_forces(state, 0.5 * h);
  update_images(state, band_);
  state.time += h;
}

} // namespace lattice
