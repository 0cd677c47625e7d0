#include "lattice/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <omp.h>

namespace latcon::lattice
{
namespace
{

// Skin over the contact distance. The number of candidate pairs grows with its square, the time between rebuilds in
// proportion.
constexpr double skin_over_distance = 1.;

// Candidates below which one thread is faster.
constexpr std::size_t min_candidates_for_threads = 512;

constexpr double nowhere = std::numeric_limits<double>::infinity();

void insert(std::vector<std::size_t> &sorted, std::size_t item)
{
  sorted.insert(std::lower_bound(sorted.begin(), sorted.end(), item), item);
}

void erase(std::vector<std::size_t> &sorted, std::size_t item)
{
  sorted.erase(std::lower_bound(sorted.begin(), sorted.end(), item));
}

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
    cells_(law.distance + skin_), number_(lattice_.n_places()), sent_(band.n_ranks()), received_(band.n_ranks())
{
  if (!(law.stiffness > 0.) || !(law.viscosity >= 0.))
    throw std::invalid_argument("a contact needs a positive stiffness and a viscosity that is not negative");
  if (!lattice_.images().empty())
    throw std::invalid_argument("sites of a periodic sheet do not touch: it does not break");
}

void Contact::find_candidates(const State &state)
{
  for (const std::size_t place : places_)
    number_[place] = 0;
  places_.clear();
  listed_at_.clear();
  neighbours_.clear();
  has_exchanged_.clear();
  order_.clear();
  own_.clear();
  cells_.clear();
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (state.lost_bonds[place] > 0 && state.removed[place] == 0)
      add_candidate(place);
}

void Contact::add_candidate(std::size_t place)
{
  if (band_.owns(place))
    own_.push_back(places_.size());
  order_.push_back(places_.size());
  places_.push_back(place);
  listed_at_.emplace_back(nowhere, nowhere);
  neighbours_.emplace_back();
  has_exchanged_.push_back(0);
  number_[place] = static_cast<std::uint32_t>(places_.size());
}

void Contact::add_broken_bonds(const std::vector<BrokenBond> &broken)
{
  for (const BrokenBond &bond : broken)
    for (const std::size_t place : {bond.near, bond.far})
      if (number_[place] == 0)
        add_candidate(place);
      else // a bond kept it from being a pair with the other end
        listed_at_[number_[place] - 1] = {nowhere, nowhere};
}

// None of two candidates has moved by more than half the skin since it was listed, so those that were farther apart
// than distance + skin where they were listed cannot touch.
void Contact::update_lists(const State &state)
{
  struct Listing
  {
    std::size_t index;
    double x, y;
  };
  const double limit_square = 0.25 * skin_ * skin_;
  std::vector<Listing> own;
  for (const std::size_t index : own_)
  {
    const Eigen::Vector2d here(state.x[places_[index]], state.y[places_[index]]);
    if ((here - listed_at_[index]).squaredNorm() > limit_square)
      own.push_back({index, here.x(), here.y()});
  }
  const std::vector<Listing> all = band_.all_gather(own);
  for (const auto &[index, x, y] : all)
  {
    listed_at_[index] = {x, y};
    cells_.put(index, x, y);
    list(state, index);
  }
  n_listings_ += all.size();
  // Those added since then into the others.
  const auto is_before = [this](std::size_t first, std::size_t second) { return places_[first] < places_[second]; };
  const auto added = std::is_sorted_until(order_.begin(), order_.end(), is_before);
  std::sort(added, order_.end(), is_before);
  std::inplace_merge(order_.begin(), added, order_.end(), is_before);
  if (band_.is_shared() && !all.empty())
    find_exchanged_sites();
}

void Contact::list(const State &state, std::size_t index)
{
  const double reach = law_.distance + skin_;
  const Eigen::Vector2d &here = listed_at_[index];
  const std::size_t place = places_[index];
  std::vector<std::size_t> &found = found_, &listed = neighbours_[index];
  found.clear();
  cells_.for_each_near(here.x(), here.y(),
                       [&](std::size_t other)
                       {
                         if (other != index && (listed_at_[other] - here).squaredNorm() <= reach * reach &&
                             may_touch(state, place, places_[other]))
                           found.push_back(places_[other]);
                       });
  std::sort(found.begin(), found.end());
  if (found == listed)
    return;
  for (const std::size_t other : listed)
    if (!std::binary_search(found.begin(), found.end(), other))
      erase(neighbours_[number_[other] - 1], place);
  for (const std::size_t other : found)
    if (!std::binary_search(listed.begin(), listed.end(), other))
      insert(neighbours_[number_[other] - 1], place);
  listed = found;
  if (band_.is_shared())
    has_exchanged_[index] =
      std::any_of(listed.begin(), listed.end(), [&](std::size_t other) { return is_exchanged(place, other); }) ? 1 : 0;
}

// Returns whether no bond joins two sites, at least one of which is in the band. Sites that never had a bond are in
// contact only if they were farther apart than the contact distance from the start.
bool Contact::may_touch(const State &state, std::size_t first, std::size_t second) const
{
  if (!band_.owns(first) && !band_.owns(second))
    return false;
  for (const auto &[near, far] : {std::pair(first, second), std::pair(second, first)})
    for (std::size_t kind = 0; kind < state.bonds.n_kinds(); ++kind)
      if (lattice_.bond(near, kind).far == far && lattice_.has_bond(near, kind))
        return !state.bonds.present(near, kind);
  return lattice_.is_triangular() || (lattice_.reference(second) - lattice_.reference(first)).norm() >= law_.distance;
}

// Returns whether the sites of a pair are of two ranks of which one does not know the other's site.
bool Contact::is_exchanged(std::size_t first, std::size_t second) const
{
  const std::size_t ranks[] = {band_.owner(lattice_.row_of(first)), band_.owner(lattice_.row_of(second))};
  return ranks[0] != ranks[1] && !(band_.is_relevant_to(ranks[0], second) && band_.is_relevant_to(ranks[1], first));
}

// Both ranks of a pair list it, hence find the same sites.
void Contact::find_exchanged_sites()
{
  for (SitesOfRanks *sites : {&sent_, &received_})
    sites->assign(band_.n_ranks(), {});
  for (std::size_t index = 0; index < places_.size(); ++index)
  {
    if (has_exchanged_[index] == 0)
      continue;
    for (const std::size_t neighbour : neighbours_[index])
    {
      if (!is_exchanged(places_[index], neighbour))
        continue;
      const auto [mine, theirs] =
        band_.owns(neighbour) ? std::pair(neighbour, places_[index]) : std::pair(places_[index], neighbour);
      const std::size_t rank = band_.owner(lattice_.row_of(theirs));
      sent_[rank].push_back(mine);
      received_[rank].push_back(theirs);
    }
  }
  for (SitesOfRanks *sites : {&sent_, &received_})
    for (std::vector<std::size_t> &of_rank : *sites)
    {
      std::sort(of_rank.begin(), of_rank.end());
      of_rank.erase(std::unique(of_rank.begin(), of_rank.end()), of_rank.end());
    }
}

const std::vector<SiteForce> &Contact::evaluate(State &state, Field &vx, Field &vy)
{
  update_lists(state);
  band_.exchange(sent_, received_, {&state.x, &state.y, &vx, &vy});
  const std::size_t n_shares =
    order_.size() < min_candidates_for_threads ? 1 : static_cast<std::size_t>(omp_get_max_threads());
  const auto n = static_cast<std::ptrdiff_t>(n_shares);
  forces_of_shares_.resize(n_shares);
  std::size_t touching = 0;
#pragma omp parallel for schedule(static) reduction(+ : touching) if (n_shares > 1)
  for (std::ptrdiff_t i = 0; i < n; ++i)
  {
    const auto share = static_cast<std::size_t>(i);
    std::vector<SiteForce> &forces = forces_of_shares_[share];
    forces.clear();
    for_each_pair(order_.size() * share / n_shares, order_.size() * (share + 1) / n_shares,
                  [&](std::size_t first, std::size_t second)
                  {
                    const Eigen::Vector2d between(state.x[second] - state.x[first], state.y[second] - state.y[first]);
                    const double square = between.squaredNorm();
                    // Sites in one place have no line between them to act along.
                    if (!(square < law_.distance * law_.distance) || square == 0.)
                      return;
                    touching += band_.owns(first) ? 1 : 0;
                    const double r = std::sqrt(square);
                    const Eigen::Vector2d direction = between / r;
                    const double approach =
                      -direction.dot(Eigen::Vector2d(vx[second] - vx[first], vy[second] - vy[first]));
                    const double repulsion = law_.stiffness * (law_.distance - r) + law_.viscosity * approach;
                    if (!(repulsion > 0.))
                      return;
                    const Eigen::Vector2d force = repulsion * direction;
                    if (band_.owns(first))
                      forces.push_back({first, -force});
                    if (band_.owns(second))
                      forces.push_back({second, force});
                  });
  }
  n_touching_ = touching;
  forces_.clear();
  for (const std::vector<SiteForce> &of_share : forces_of_shares_) // the order of pairs, however many shares
    forces_.insert(forces_.end(), of_share.begin(), of_share.end());
  return forces_;
}

double Contact::elastic_energy(const State &state) const
{
  double energy = 0.;
  for_each_pair(0, order_.size(),
                [&](std::size_t first, std::size_t second)
                {
                  if (!band_.owns(first))
                    return;
                  const double r = std::hypot(state.x[second] - state.x[first], state.y[second] - state.y[first]);
                  const double overlap = std::max(0., law_.distance - r);
                  energy += 0.5 * law_.stiffness * overlap * overlap;
                });
  return energy;
}

} // namespace latcon::lattice
