#include "lattice/constraint.h"

#include <algorithm>

namespace latcon::lattice
{
namespace
{

std::uint8_t components(const Constraint &constraint)
{
  return static_cast<std::uint8_t>((constraint.along_x ? 1 : 0) | (constraint.along_y ? 2 : 0));
}

// The components of a vector that are prescribed.
Eigen::Vector2d prescribed(const Constraint &constraint, const Eigen::Vector2d &vector)
{
  return {constraint.along_x ? vector.x() : 0., constraint.along_y ? vector.y() : 0.};
}

void set_velocity(State &state, const Constraint &constraint, std::size_t place, const Eigen::Vector2d &velocity)
{
  for (const std::size_t axis : axes)
    if ((components(constraint) >> axis & 1) != 0)
      state.velocity[axis][place] = velocity[static_cast<Eigen::Index>(axis)];
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
    set_velocity(state, constraint, place, Eigen::Vector2d::Zero());
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
      if (band_.owns(place) && state.removed[place] == 0)
        work[lattice.row_of(place)] += half_mass * prescribed(constraint_, state.velocity.at(place)).squaredNorm();
    return true;
  }
  const AffineVelocity velocity = constraint_.motion ? constraint_.motion(from, to) : AffineVelocity{};
  if (velocity == velocity_)
    return false;
  velocity_ = velocity;
  for (const std::size_t place : constraint_.sites)
    if (band_.is_relevant(place) && state.removed[place] == 0)
      set_velocity(state, constraint_, place, velocity.at(lattice.reference(place)));
  return true;
}

void PrescribedMotion::add_power(const State &state, const VectorField &on_sites,
                                 const std::vector<const SiteForces *> &site_forces, std::vector<double> &of_rows) const
{
  if (released_ != 0 || velocity_ == AffineVelocity{})
    return;
  const TriangularLattice &lattice = band_.lattice();
  const std::vector<std::size_t> &sites = constraint_.sites;
  const auto add = [&](std::size_t place, const Eigen::Vector2d &force)
  { of_rows[lattice.row_of(place)] -= prescribed(constraint_, force).dot(state.velocity.at(place)); };
  for (const std::size_t place : sites)
    if (band_.owns(place) && state.removed[place] == 0)
      add(place, on_sites.at(place));
  for (const SiteForces *others : site_forces)
    for (const SiteForce &on : others->last())
      if (std::binary_search(sites.begin(), sites.end(), on.place))
        add(on.place, on.force);
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
