#include "lattice/contact.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include <omp.h>

namespace latcon::lattice
{
namespace
{

// Skin over the contact distance. The number of candidate pairs grows with its square, the time between rebuilds in
// proportion.
constexpr double skin_over_distance = 1.;

// Pairs, or candidates to be paired, below which one thread is faster.
constexpr std::size_t min_pairs_for_threads = 1024;

// Calls work(begin, end, part) for shares of 0 ... n - 1 that follow each other, each by another thread, and appends
// the parts to `all` in the order of the shares, which does not depend on their number.
// @param parts scratch
template <class Item, class Work>
void in_shares(std::size_t n, std::vector<std::vector<Item>> &parts, std::vector<Item> &all, const Work &work)
{
  if (n < min_pairs_for_threads)
  {
    work(std::size_t{0}, n, all);
    return;
  }
  parts.resize(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  {
    const auto count = static_cast<std::size_t>(omp_get_num_threads()),
               i = static_cast<std::size_t>(omp_get_thread_num());
    parts[i].clear();
    work(n * i / count, n * (i + 1) / count, parts[i]);
#pragma omp barrier
#pragma omp single
    for (std::size_t part = 0; part < count; ++part)
      all.insert(all.end(), parts[part].begin(), parts[part].end());
  }
}

} // namespace

ContactLaw contact_like_nearest_bond(const TriangularLattice &lattice, const Material &material, double distance,
                                     double stiffness, double viscosity)
{
  const double per_length = cross_section(material.nearest, lattice) / lattice.rest_length(0);
  return {distance, stiffness * per_length * lattice::stiffness(material.nearest.law, 1.),
          viscosity * per_length * material.nearest.viscosity};
}

Contact::Contact(const RowPartition &band, const ContactLaw &law)
  : band_(band), lattice_(band.lattice()), law_(law), skin_(skin_over_distance * law.distance),
    cells_(law.distance + skin_), is_candidate_(lattice_.n_places())
{
  if (!(law.stiffness > 0.) || !(law.viscosity >= 0.))
    throw std::invalid_argument("a contact needs a positive stiffness and a viscosity that is not negative");
  if (!lattice_.images().empty())
    throw std::invalid_argument("sites of a periodic sheet do not touch: it does not break");
}

void Contact::find_candidates(const State &state)
{
  places_.clear();
  found_.clear();
  pairs_.clear();
  cells_.clear(0);
  is_candidate_ = SiteFlags(lattice_.n_places());
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (state.lost_bonds[place] > 0 && state.removed[place] == 0)
    {
      is_candidate_[place] = 1;
      places_.push_back(place);
    }
}

void Contact::rebuild(const State &state)
{
  pairs_.clear();
  found_.clear();
  // Room for what is added until the next time.
  cells_.clear(2 * places_.size() + 64);
  for (std::size_t index = 0; index < places_.size(); ++index)
  {
    found_.emplace_back(state.x[places_[index]], state.y[places_[index]]);
    cells_.insert(index, found_.back().x(), found_.back().y());
  }
  const double reach_square = (law_.distance + skin_) * (law_.distance + skin_);
  const auto find = [&](std::size_t begin, std::size_t end, std::vector<Pair> &pairs)
  {
    for (std::size_t first = begin; first < end; ++first)
      cells_.for_each_near(found_[first].x(), found_[first].y(),
                           [&](std::size_t second)
                           {
                             if (places_[first] < places_[second] &&
                                 (found_[second] - found_[first]).squaredNorm() <= reach_square &&
                                 may_touch(state, places_[first], places_[second]))
                               pairs.push_back({places_[first], places_[second]});
                           });
  };
  in_shares(places_.size(), pairs_of_threads_, pairs_, find);
  std::sort(pairs_.begin(), pairs_.end());
}

bool Contact::has_moved(const State &state) const
{
  const double limit_square = 0.25 * skin_ * skin_;
  for (std::size_t index = 0; index < found_.size(); ++index)
  {
    const Eigen::Vector2d now(state.x[places_[index]], state.y[places_[index]]);
    if ((now - found_[index]).squaredNorm() > limit_square)
      return true;
  }
  return false;
}

void Contact::add_broken_bonds(const State &state, const std::vector<BrokenBond> &broken)
{
  if (found_.size() < places_.size())
    rebuild(state);
  const double reach = law_.distance + skin_;
  for (const BrokenBond &bond : broken)
  {
    // Between two candidates there is no pair yet, since a bond has joined them; else the new one finds the other.
    if (is_candidate_[bond.near] != 0 && is_candidate_[bond.far] != 0 && may_touch(state, bond.near, bond.far) &&
        std::hypot(state.x[bond.far] - state.x[bond.near], state.y[bond.far] - state.y[bond.near]) <= reach + skin_)
      insert_pair(bond.near, bond.far);
    for (const std::size_t place : {bond.near, bond.far})
      if (is_candidate_[place] == 0)
        add_candidate(state, place);
  }
}

// Pairs of a list that was made at different times for different candidates: none of them has moved by more than half
// the skin since its own, so pairs farther apart than distance + skin then cannot touch.
void Contact::add_candidate(const State &state, std::size_t place)
{
  const Eigen::Vector2d here(state.x[place], state.y[place]);
  const double reach = law_.distance + skin_;
  cells_.for_each_near(here.x(), here.y(),
                       [&](std::size_t index)
                       {
                         if ((found_[index] - here).norm() <= reach && may_touch(state, place, places_[index]))
                           insert_pair(place, places_[index]);
                       });
  cells_.insert(places_.size(), here.x(), here.y());
  places_.push_back(place);
  found_.push_back(here);
  is_candidate_[place] = 1;
}

void Contact::insert_pair(std::size_t a, std::size_t b)
{
  const Pair pair{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
  if (at == pairs_.end() || pair < *at)
    pairs_.insert(at, pair);
}

// Returns whether no bond joins two sites, at least one of which is in the band.
bool Contact::may_touch(const State &state, std::size_t first, std::size_t second) const
{
  if (!band_.owns(first) && !band_.owns(second))
    return false;
  for (const auto &[near, far] : {std::pair(first, second), std::pair(second, first)})
    for (std::size_t kind = 0; kind < state.bonds.n_kinds(); ++kind)
      if (lattice_.bond(near, kind).far == far)
        return !state.bonds.present(near, kind);
  return true;
}

const std::vector<SiteForce> &Contact::evaluate(const State &state, const Field &vx, const Field &vy)
{
  if (found_.size() < places_.size())
    rebuild(state);
  else if (has_moved(state))
  {
    rebuild(state);
    ++n_list_builds_;
  }
  forces_.clear();
  std::atomic<std::size_t> n_touching{0};
  const auto push_apart = [&](std::size_t begin, std::size_t end, std::vector<SiteForce> &forces)
  {
    std::size_t touching = 0;
    for (std::size_t pair = begin; pair < end; ++pair)
    {
      const auto &[first, second] = pairs_[pair];
      const Eigen::Vector2d between(state.x[second] - state.x[first], state.y[second] - state.y[first]);
      const double square = between.squaredNorm();
      // Sites in one place have no line between them to act along.
      if (!(square < law_.distance * law_.distance) || square == 0.)
        continue;
      touching += band_.owns(first) ? 1 : 0;
      const double r = std::sqrt(square);
      const Eigen::Vector2d direction = between / r;
      const double approach = -direction.dot(Eigen::Vector2d(vx[second] - vx[first], vy[second] - vy[first]));
      const double repulsion = law_.stiffness * (law_.distance - r) + law_.viscosity * approach;
      if (!(repulsion > 0.))
        continue;
      const Eigen::Vector2d force = repulsion * direction;
      if (band_.owns(first))
        forces.push_back({first, -force});
      if (band_.owns(second))
        forces.push_back({second, force});
    }
    n_touching += touching;
  };
  in_shares(pairs_.size(), forces_of_threads_, forces_, push_apart);
  n_touching_ = n_touching;
  return forces_;
}

double Contact::elastic_energy(const State &state) const
{
  double energy = 0.;
  for (const auto &[first, second] : pairs_)
  {
    if (!band_.owns(first))
      continue;
    const double r = std::hypot(state.x[second] - state.x[first], state.y[second] - state.y[first]);
    const double overlap = std::max(0., law_.distance - r);
    energy += 0.5 * law_.stiffness * overlap * overlap;
  }
  return energy;
}

} // namespace latcon::lattice
