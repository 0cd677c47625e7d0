#include "lattice/contact.h"

#include <algorithm>
#include <cmath>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

// Skin over the contact distance. The number of candidate pairs grows with its square, the time between rebuilds in
// proportion.
constexpr double skin_over_distance = 1.;

} // namespace

ContactLaw contact_like_nearest_bond(const TriangularLattice &lattice, const Material &material, double distance,
                                     double stiffness, double viscosity)
{
  // Points of a continuum repel each other in proportion to the areas of both.
  const double d = lattice.lattice_spacing(), area = half_sqrt3 * d * d, share = lattice.site_area() / area;
  const double per_length = share * share * (material.nearest.area_factor * area / d / d);
  return {distance, stiffness * per_length * lattice::stiffness(material.nearest.law, 1.),
          viscosity * per_length * material.nearest.viscosity};
}

Contact::Contact(const RowPartition &band, const ContactLaw &law)
  : band_(band), lattice_(band.lattice()), law_(law), skin_(skin_over_distance * law.distance),
    cells_(law.distance + skin_), sent_(band.n_ranks()), received_(band.n_ranks())
{
  support::require(law.stiffness > 0. && law.viscosity >= 0.,
                   "a contact needs a positive stiffness and a viscosity that is not negative");
  support::require(lattice_.images().empty(), "sites of a periodic sheet do not touch: it does not break");
}

void Contact::find_candidates(const State &state)
{
  candidates_.clear();
  cells_.clear();
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (state.lost_bonds[place] > 0 && state.removed[place] == 0)
      candidates_.emplace_hint(candidates_.end(), place, Candidate());
}

void Contact::add_broken_bonds(const std::vector<BrokenBond> &broken)
{
  for (const BrokenBond &bond : broken)
    for (const std::size_t place : {bond.near, bond.far})
      candidates_[place].is_listed = false; // a bond kept it from being a pair with the other end
}

// None of two candidates has moved by more than half the skin since it was listed, so those that were farther apart
// than distance + skin where they were listed cannot touch.
void Contact::update_lists(const State &state)
{
  struct Listing
  {
    std::size_t place;
    double x, y;
  };
  std::vector<Listing> own;
  for (const auto &[place, candidate] : candidates_)
  {
    const Eigen::Vector2d here = state.position.at(place);
    if (band_.owns(place) &&
        (!candidate.is_listed || (here - candidate.listed_at).squaredNorm() > 0.25 * skin_ * skin_))
      own.push_back({place, here.x(), here.y()});
  }
  for (const auto &[place, x, y] : band_.all_gather(own))
    list(state, place, {x, y});
}

void Contact::list(const State &state, std::size_t place, const Eigen::Vector2d &here)
{
  const double reach = law_.distance + skin_;
  Candidate &candidate = candidates_[place];
  cells_.move(place, candidate.listed_at, here);
  candidate.is_listed = true;
  candidate.listed_at = here;
  candidate.above.clear();
  cells_.for_each_near(here,
                       [&](const LinkCells::Point &other)
                       {
                         if (other.id == place || (other.position - here).squaredNorm() > reach * reach ||
                             !may_touch(state, place, other.id))
                           return;
                         candidates_[std::min(place, other.id)].above.insert(std::max(place, other.id));
                         exchange(place, other.id);
                       });
}

// Returns whether no bond joins two sites, at least one of which is in the band. Sites that never had a bond are in
// contact only if they were farther apart than the contact distance from the start.
bool Contact::may_touch(const State &state, std::size_t first, std::size_t second) const
{
  if (!band_.owns(first) && !band_.owns(second))
    return false;
  const auto [near, far] = std::minmax({first, second}); // bonds lead to larger places
  for (std::size_t kind = 0; kind < state.bonds.n_kinds(); ++kind)
    if (lattice_.bond(near, kind).far == far && lattice_.has_bond(near, kind))
      return !state.bonds.present(near, kind);
  return lattice_.is_triangular() || (lattice_.reference(second) - lattice_.reference(first)).norm() >= law_.distance;
}

// Exchanges the sites of a pair from now on if another rank, which lists it too, has one of them.
void Contact::exchange(std::size_t first, std::size_t second)
{
  if (band_.owns(first) == band_.owns(second))
    return;
  const auto [mine, theirs] = band_.owns(first) ? std::pair(first, second) : std::pair(second, first);
  const std::size_t rank = band_.owner(lattice_.row_of(theirs));
  sent_[rank].insert(mine);
  received_[rank].insert(theirs);
}

const std::vector<SiteForce> &Contact::evaluate(State &state, VectorField &velocity)
{
  update_lists(state);
  band_.exchange(sent_, received_, {&state.position.x, &state.position.y, &velocity.x, &velocity.y});
  forces_.clear();
  // By one thread: waking others would take longer.
  for (const auto &[first, candidate] : candidates_)
    for (const std::size_t second : candidate.above)
    {
      const Eigen::Vector2d between = state.position.difference(first, second);
      const double square = between.squaredNorm();
      // Sites in one place have no line between them to act along.
      if (!(square < law_.distance * law_.distance) || square == 0.)
        continue;
      const double r = std::sqrt(square);
      const Eigen::Vector2d direction = between / r;
      const double approach = -direction.dot(velocity.difference(first, second));
      const double repulsion = law_.stiffness * (law_.distance - r) + law_.viscosity * approach;
      if (!(repulsion > 0.))
        continue;
      const Eigen::Vector2d force = repulsion * direction;
      if (band_.owns(first))
        forces_.push_back({first, -force});
      if (band_.owns(second))
        forces_.push_back({second, force});
    }
  return forces_;
}

} // namespace latcon::lattice
