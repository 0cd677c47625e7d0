#include "lattice/velocity_verlet.h"

#include <algorithm>
#include <stdexcept>

#include "lattice/row_kernels.h"

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
    operation(static_cast<std::size_t>(row));
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
               [&](std::size_t row)
               {
                 const std::size_t first = lattice_.index(row, 0), n = lattice_.columns();
                 std::copy_n(&state.vx[first], n, &predicted_vx_[first]);
                 std::copy_n(&state.vy[first], n, &predicted_vy_[first]);
               });
  halo_.start(evaluated_fields(state));
  halo_.finish();
  update_all_images(state);
  forces_.evaluate(
    state, predicted_vx_, predicted_vy_,
    {{}, {}, [&](std::size_t row, const double *fx, const double *fy) { kick(state, row, fx, fy, 0.); }});
  evaluate_site_forces(state);
  add_site_forces(state, 0.);
}

std::vector<Field *> VelocityVerlet::evaluated_fields(State &state)
{
  return {&state.x, &state.y, &predicted_vx_, &predicted_vy_};
}

void VelocityVerlet::update_all_images(State &state)
{
  update_images(state, band_);
  for (const TriangularLattice::Image &image : lattice_.images())
    if (band_.knows(image.site))
    {
      predicted_vx_[image.place] = predicted_vx_[image.site];
      predicted_vy_[image.place] = predicted_vy_[image.site];
    }
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

void VelocityVerlet::update_accelerations(State &state, const std::vector<std::size_t> &places) const
{
  const auto of_bonds = [&](std::size_t place)
  {
    const Eigen::Vector2d force = forces_.on_site(state, predicted_vx_, predicted_vy_, place);
    state.ax[place] = force.x() * state.inverse_mass[place];
    state.ay[place] = force.y() * state.inverse_mass[place];
  };
  for (const std::size_t place : places)
    if (band_.owns(place))
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
  const auto drift_row = [&](std::size_t row) { drift(state, row); };
  const auto after = [&](std::size_t row, const double *fx, const double *fy)
  { kick(state, row, fx, fy, 0.5 * time_step_); };
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
    forces_.evaluate(state, predicted_vx_, predicted_vy_,
                     {before,
                      {&state.x, &state.y, &state.vx, &state.vy, &state.ax, &state.ay, &predicted_vx_, &predicted_vy_},
                      after});
  }
  else
  {
    for_each_row(lattice_, interior, drift_row);
    halo_.finish();
    update_all_images(state);
    forces_.evaluate(state, predicted_vx_, predicted_vy_, {{}, {}, after});
  }
  evaluate_site_forces(state);
  add_site_forces(state, 0.5 * time_step_);
  update_images(state, band_);
  state.time += time_step_;
}

} // namespace lattice
