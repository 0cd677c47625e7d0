#include "lattice/contact.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lattice
{
namespace
{

// Of the contact distance. Pairs to look at grow with its square, the time between rebuilds with itself.
constexpr double skin_over_distance = 1.;

} // namespace

ContactLaw contact_like_nearest_bond(const TriangularLattice &lattice, const Material &material, double distance,
                                     double stiffness, double viscosity)
{
  const double per_length = cross_section(material.nearest, lattice) / lattice.rest_length(0);
  return {distance, stiffness * per_length * lattice::stiffness(material.nearest.law, 1.),
          viscosity * per_length * material.nearest.viscosity};
}

Contact::Contact(const TriangularLattice &lattice, const ContactLaw &law)
  : lattice_(lattice), law_(law), skin_(skin_over_distance * law.distance), cells_(law.distance + skin_),
    is_candidate_(lattice.n_places(), 0)
{
  if (!(law.stiffness > 0.) || !(law.viscosity >= 0.))
    throw std::invalid_argument("a contact needs a positive stiffness and a viscosity that is not negative");
  if (!lattice.images().empty())
    throw std::invalid_argument("sites of a periodic sheet do not touch: it does not break");
}

void Contact::find_candidates(const State &state)
{
  candidates_.clear();
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
  {
    is_candidate_[place] = state.lost_bonds[place] > 0 && state.removed[place] == 0 ? 1 : 0;
    if (is_candidate_[place] != 0)
      candidates_.push_back({place, 0., 0.});
  }
  rebuild(state);
}

void Contact::rebuild(const State &state)
{
  pairs_.clear();
  // Room for what is added until the next time.
  cells_.clear(2 * candidates_.size() + 64);
  for (std::size_t index = 0; index < candidates_.size(); ++index)
  {
    Candidate &candidate = candidates_[index];
    candidate.x = state.x[candidate.place];
    candidate.y = state.y[candidate.place];
    cells_.insert(index, candidate.x, candidate.y);
  }
  const double reach_square = (law_.distance + skin_) * (law_.distance + skin_);
  for (const Candidate &candidate : candidates_)
    cells_.for_each_near(candidate.x, candidate.y,
                         [&](std::size_t index)
                         {
                           const Candidate &other = candidates_[index];
                           const double dx = other.x - candidate.x, dy = other.y - candidate.y;
                           if (candidate.place < other.place && dx * dx + dy * dy <= reach_square &&
                               !bonded(state, candidate.place, other.place))
                             pairs_.push_back({candidate.place, other.place});
                         });
  std::sort(pairs_.begin(), pairs_.end());
}

bool Contact::has_moved(const State &state) const
{
  const double limit_square = 0.25 * skin_ * skin_;
  return std::any_of(candidates_.begin(), candidates_.end(),
                     [&](const Candidate &candidate)
                     {
                       const double dx = state.x[candidate.place] - candidate.x;
                       const double dy = state.y[candidate.place] - candidate.y;
                       return dx * dx + dy * dy > limit_square;
                     });
}

void Contact::note(const State &state, const std::vector<BrokenBond> &broken)
{
  const double reach = law_.distance + skin_;
  for (const BrokenBond &bond : broken)
  {
    // Between two candidates there is no pair yet, since a bond has joined them; else the new one finds the other.
    if (is_candidate_[bond.near] != 0 && is_candidate_[bond.far] != 0 &&
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
  const Candidate added{place, state.x[place], state.y[place]};
  const double reach = law_.distance + skin_;
  cells_.for_each_near(added.x, added.y,
                       [&](std::size_t index)
                       {
                         const Candidate &other = candidates_[index];
                         if (std::hypot(other.x - added.x, other.y - added.y) <= reach &&
                             !bonded(state, place, other.place))
                           insert_pair(place, other.place);
                       });
  cells_.insert(candidates_.size(), added.x, added.y);
  candidates_.push_back(added);
  is_candidate_[place] = 1;
}

void Contact::insert_pair(std::size_t a, std::size_t b)
{
  const Pair pair{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
  if (at == pairs_.end() || pair < *at)
    pairs_.insert(at, pair);
}

bool Contact::bonded(const State &state, std::size_t first, std::size_t second) const
{
  for (const auto &[near, far] : {std::pair(first, second), std::pair(second, first)})
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      if (near + static_cast<std::size_t>(lattice_.shift(kind, lattice_.row_of(near))) == far)
        return state.bonds.present(near, kind);
  return false;
}

const std::vector<SiteForce> &Contact::evaluate(const State &state, const Field &vx, const Field &vy)
{
  if (has_moved(state))
  {
    rebuild(state);
    ++n_rebuilt_;
  }
  forces_.clear();
  n_touching_ = 0;
  for (const auto &[first, second] : pairs_)
  {
    const Eigen::Vector2d between(state.x[second] - state.x[first], state.y[second] - state.y[first]);
    const double square = between.squaredNorm();
    // Sites in one place have no line between them to act along.
    if (!(square < law_.distance * law_.distance) || square == 0.)
      continue;
    ++n_touching_;
    const double r = std::sqrt(square);
    const Eigen::Vector2d direction = between / r;
    const double approach = -direction.dot(Eigen::Vector2d(vx[second] - vx[first], vy[second] - vy[first]));
    const double repulsion = law_.stiffness * (law_.distance - r) + law_.viscosity * approach;
    if (!(repulsion > 0.))
      continue;
    const Eigen::Vector2d force = repulsion * direction;
    forces_.push_back({first, -force});
    forces_.push_back({second, force});
  }
  return forces_;
}

double Contact::elastic_energy(const State &state) const
{
  double energy = 0.;
  for (const auto &[first, second] : pairs_)
  {
    const double r = std::hypot(state.x[second] - state.x[first], state.y[second] - state.y[first]);
    const double overlap = std::max(0., law_.distance - r);
    energy += 0.5 * law_.stiffness * overlap * overlap;
  }
  return energy;
}

} // namespace lattice
