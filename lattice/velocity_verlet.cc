#include "lattice/velocity_verlet.h"

#include <stdexcept>

#include "lattice/row_kernels.h"

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
    operation(static_cast<std::size_t>(row));
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
  forces_.evaluate(
    state, predicted_vx_, predicted_vy_,
    {{}, {}, [&](std::size_t row, const double *fx, const double *fy) { kick(state, row, fx, fy, 0.); }});
  evaluate_site_forces(state);
  add_site_forces(state, 0.);
}

void VelocityVerlet::evaluate_site_forces(const State &state)
{
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

void VelocityVerlet::update_accelerations(State &state, const std::vector<std::size_t> &places) const
{
  const auto of_bonds = [&](std::size_t place)
  {
    const Eigen::Vector2d force = forces_.on_site(state, predicted_vx_, predicted_vy_, place);
    state.ax[place] = force.x() * state.inverse_mass[place];
    state.ay[place] = force.y() * state.inverse_mass[place];
  };
  for (const std::size_t place : places)
    of_bonds(place);
  for (const SiteForces *forces : site_forces_)
    for (const SiteForce &force : forces->last())
      of_bonds(force.place);
  add_site_forces(state, 0.);
}

void VelocityVerlet::drift(State &state, std::size_t row)
{
  const std::size_t begin = lattice_.index(row, 0), n = lattice_.columns();
  kernels::drift(time_step_, n, &state.ax[begin], &state.vx[begin], &state.x[begin], &predicted_vx_[begin]);
  kernels::drift(time_step_, n, &state.ay[begin], &state.vy[begin], &state.y[begin], &predicted_vy_[begin]);
}

void VelocityVerlet::kick(State &state, std::size_t row, const double *fx, const double *fy, double duration) const
{
  const std::size_t begin = lattice_.index(row, 0), n = lattice_.columns();
  const double *const inverse_mass = &state.inverse_mass[begin];
  kernels::kick(duration, n, fx, inverse_mass, &state.ax[begin], &state.vx[begin]);
  kernels::kick(duration, n, fy, inverse_mass, &state.ay[begin], &state.vy[begin]);
}

void VelocityVerlet::step(State &state)
{
  const auto before = [&](std::size_t row) { drift(state, row); };
  const auto after = [&](std::size_t row, const double *fx, const double *fy)
  { kick(state, row, fx, fy, 0.5 * time_step_); };
  if (lattice_.images().empty())
    forces_.evaluate(state, predicted_vx_, predicted_vy_,
                     {before,
                      {&state.x, &state.y, &state.vx, &state.vy, &state.ax, &state.ay, &predicted_vx_, &predicted_vy_},
                      after});
  else
  {
    for_each_row(lattice_, before);
    update_images(state, lattice_);
    for (const TriangularLattice::Image &image : lattice_.images())
    {
      predicted_vx_[image.place] = predicted_vx_[image.site];
      predicted_vy_[image.place] = predicted_vy_[image.site];
    }
    forces_.evaluate(state, predicted_vx_, predicted_vy_, {{}, {}, after});
  }
  evaluate_site_forces(state);
  add_site_forces(state, 0.5 * time_step_);
  update_images(state, lattice_);
  state.time += time_step_;
}

} // namespace lattice
