#include "lattice/constraint.h"

#include <algorithm>
#include <functional>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

std::uint8_t components(const Constraint &constraint)
{
  return static_cast<std::uint8_t>((constraint.along_x ? 1 : 0) | (constraint.along_y ? 2 : 0));
}

} // namespace

std::vector<std::size_t> held_sites(const State &state, const TriangularLattice &lattice)
{
  std::vector<std::size_t> sites;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (state.held[place] != 0 && lattice.is_site(place))
      sites.push_back(place);
  return sites;
}

Constraint::Motion steady(const Eigen::Matrix2d &velocity_gradient)
{
  return [velocity_gradient](double, double) { return AffineVelocity{Eigen::Vector2d::Zero(), velocity_gradient}; };
}

Constraint::Motion piecewise_linear(std::vector<double> times, std::vector<Eigen::Matrix2d> deformations)
{
  support::require(times.size() == deformations.size() &&
                     std::is_sorted(times.begin(), times.end(), std::less_equal<>()),
                   "a piecewise linear motion needs increasing times, and a deformation for each");
  return [times = std::move(times), deformations = std::move(deformations)](double from, double to)
  {
    // The rate itself within one piece, so that it is the same number in every step; otherwise the mean.
    Eigen::Matrix2d change = Eigen::Matrix2d::Zero();
    for (std::size_t i = 1; i < times.size(); ++i)
    {
      const double overlap = std::min(to, times[i]) - std::max(from, times[i - 1]);
      if (!(overlap > 0.))
        continue;
      const Eigen::Matrix2d rate = (deformations[i] - deformations[i - 1]) / (times[i] - times[i - 1]);
      if (from >= times[i - 1] && to <= times[i])
        return AffineVelocity{Eigen::Vector2d::Zero(), rate};
      change += overlap * rate;
    }
    return AffineVelocity{Eigen::Vector2d::Zero(), change / (to - from)};
  };
}

void constrain(State &state, const RowPartition &band, const Constraint &constraint)
{
  const TriangularLattice &lattice = band.lattice();
  for (const std::size_t place : constraint.sites)
  {
    support::require(lattice.is_site(place), "only a site can be constrained");
    if (state.removed[place] != 0 || state.held[place] != 0)
      continue;
    const bool is_whole = components(constraint) == 3;
    (is_whole ? state.held : state.rollers)[place] |= is_whole ? 1 : components(constraint);
    if (!band.is_relevant(place))
      continue;
    if (is_whole)
      state.inverse_mass[place] = 0.;
    if (constraint.along_x)
      state.vx[place] = 0.;
    if (constraint.along_y)
      state.vy[place] = 0.;
  }
}

PrescribedMotion::PrescribedMotion(const RowPartition &band, Constraint constraint)
  : band_(band), constraint_(std::move(constraint))
{
  std::sort(constraint_.sites.begin(), constraint_.sites.end());
}

bool PrescribedMotion::overlaps(const PrescribedMotion &other) const
{
  const std::vector<std::size_t> &own = constraint_.sites, &others = other.constraint_.sites;
  return (components(constraint_) & components(other.constraint_)) != 0 &&
         std::any_of(own.begin(), own.end(),
                     [&](std::size_t place) { return std::binary_search(others.begin(), others.end(), place); });
}

bool PrescribedMotion::prescribe(State &state, const Material &material, double from, double to,
                                 std::vector<double> &work)
{
  if (released_ != 0)
    return false;
  const TriangularLattice &lattice = band_.lattice();
  if (from >= constraint_.until)
  {
    released_ = 1;
    free_if_released(state, material);
    const double half_mass = 0.5 * site_mass(material, lattice);
    for (const std::size_t place : constraint_.sites)
    {
      if (!band_.owns(place) || state.removed[place] != 0)
        continue;
      const double vx = constraint_.along_x ? state.vx[place] : 0., vy = constraint_.along_y ? state.vy[place] : 0.;
      work[lattice.row_of(place)] += half_mass * (vx * vx + vy * vy);
    }
    return true;
  }
  const AffineVelocity velocity = constraint_.motion ? constraint_.motion(from, to) : AffineVelocity{};
  if (velocity == velocity_)
    return false;
  velocity_ = velocity;
  for (const std::size_t place : constraint_.sites)
  {
    if (!band_.is_relevant(place) || state.removed[place] != 0)
      continue;
    const Eigen::Vector2d v = velocity.at(lattice.reference(place));
    if (constraint_.along_x)
      state.vx[place] = v.x();
    if (constraint_.along_y)
      state.vy[place] = v.y();
  }
  return true;
}

void PrescribedMotion::add_power(const State &state, const Forces &forces, const Field &vx, const Field &vy,
                                 const std::vector<const SiteForces *> &site_forces, std::vector<double> &of_rows) const
{
  if (released_ != 0 || velocity_.is_zero())
    return;
  const TriangularLattice &lattice = band_.lattice();
  const std::vector<std::size_t> &sites = constraint_.sites;
  const auto power_of = [&](std::size_t place, const Eigen::Vector2d &force)
  {
    return (constraint_.along_x ? force.x() * state.vx[place] : 0.) +
           (constraint_.along_y ? force.y() * state.vy[place] : 0.);
  };
  std::vector<double> powers(sites.size());
  const auto n = static_cast<std::ptrdiff_t>(sites.size());
#pragma omp parallel for schedule(static) if (sites.size() >= min_sites_for_threads)
  for (std::ptrdiff_t i = 0; i < n; ++i)
    if (const std::size_t place = sites[static_cast<std::size_t>(i)]; band_.owns(place) && state.removed[place] == 0)
      powers[static_cast<std::size_t>(i)] = power_of(place, forces.on_site(state, vx, vy, place));
  for (std::size_t i = 0; i < sites.size(); ++i)
    of_rows[lattice.row_of(sites[i])] -= powers[i];
  for (const SiteForces *others : site_forces)
    for (const SiteForce &on : others->last())
      if (std::binary_search(sites.begin(), sites.end(), on.place))
        of_rows[lattice.row_of(on.place)] -= power_of(on.place, on.force);
}

void PrescribedMotion::free_if_released(State &state, const Material &material) const
{
  if (released_ == 0)
    return;
  const double inverse_mass = 1. / site_mass(material, band_.lattice());
  for (const std::size_t place : constraint_.sites)
  {
    state.rollers[place] &= static_cast<std::uint8_t>(~components(constraint_));
    if (state.removed[place] != 0 || components(constraint_) != 3)
      continue;
    state.held[place] = 0;
    if (band_.is_relevant(place))
      state.inverse_mass[place] = inverse_mass;
  }
}

} // namespace latcon::lattice
