#include "lattice/fracture.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "lattice/energy.h"

namespace latcon::lattice
{

Fracture::Fracture(const RowPartition &band, const Material &material, std::shared_ptr<const BreakingRule> rule,
                   Toughening toughening, const Eigen::Matrix2d &deformation)
  : band_(band), lattice_(band.lattice()), material_(material), rule_(std::move(rule)), toughening_(toughening),
    breaking_stretch_(rule_->smallest_limit(1.)), toughened_stretch_(rule_->smallest_limit(toughening.factor))
{
  support::require(lattice_.images().empty(), "a periodic sheet does not break: a crack has no tip there");
  support::require(toughening.factor >= 1. && toughening.distance >= 0. && toughening.retraction >= 0. &&
                     toughening.retraction < 1.,
                   "toughening needs a factor >= 1, a distance >= 0, and a fraction of retraction from 0 to below 1");
  if (toughening.retraction > 0.)
    for (std::size_t kind = 0; kind < lattice_.n_kinds(); ++kind)
      retraction_stretch_.push_back(toughening.retraction * (deformation * lattice_.bond_vector(kind)).norm() /
                                    lattice_.rest_length(kind));
}

void Fracture::configure(State &state, Forces &forces) const
{
  state.breaking_stretch = breaking_stretch_;
  state.toughened_stretch = toughened_stretch_;
  state.strength = bond_factors(band_, material_, BondProperty::strength);
  forces.set_retraction_threshold(retraction_stretch_);
}

double Fracture::limit(const State &state, const Bond &bond, double rate) const
{
  const auto [near, kind, far] = bond;
  return rule_->limit({lattice_.shell(kind), state.bonds.toughened(near, kind) ? toughening_.factor : 1.,
                       state.strength.of(near, kind), state.stiffness.of(near, kind), rate});
}

// With the expressions of the loops over a row: one that they do not flag has no event. Few bonds are past the smallest
// limit, so that the rule is asked about these alone.
Fracture::Event Fracture::event(const State &state, const Bond &bond, const VectorField &evaluated_velocity,
                                double lookahead) const
{
  const auto [near, kind, far] = bond;
  const bool toughened = state.bonds.toughened(near, kind);
  const double shortest = retraction_stretch_.empty() || toughened ? 0. : retraction_stretch_[kind],
               smallest = (toughened ? toughened_stretch_ : breaking_stretch_) * state.strength.of(near, kind);
  const auto among = [&](double value, const auto &of_stretch)
  {
    if (value > of_stretch(smallest) &&
        value > of_stretch(limit(state, bond, stretch_rate(state, lattice_, bond, evaluated_velocity))))
      return Event::broken;
    return value < of_stretch(shortest) ? Event::retracted : Event::none;
  };
  if (!(lookahead > 0.))
    return among(stretch(state, lattice_, bond), [](double stretch) { return stretch; });
  const double l = lattice_.rest_length(kind), ratio = lattice_.length_ratio(near, kind);
  const Eigen::Vector2d r = ratio * state.position.difference(near, far),
                        v = ratio * evaluated_velocity.difference(near, far);
  return among(formulas::squared_length_after(lookahead, r.x(), r.y(), v.x(), v.y()),
               [l](double stretch) { return formulas::squared_length(stretch, l); });
}

BrokenBond Fracture::broken(const State &state, const Bond &bond) const
{
  const Eigen::Vector2d midpoint = lattice_.reference(bond.near) + 0.5 * lattice_.bond_vector(bond);
  return {bond,
          state.time,
          midpoint.x(),
          midpoint.y(),
          stretch(state, lattice_, bond),
          elastic_energy(state, lattice_, material_, bond) + memory_energy(state, lattice_, material_, bond)};
}

// Takes bonds out of the sheet. @return those of all ranks in the order of storage, if `own` ones are in it
std::vector<BrokenBond> Fracture::lose_bonds(State &state, const std::vector<BrokenBond> &own, int *number) const
{
  std::vector<BrokenBond> lost = band_.all_gather(own, number);
  for (const BrokenBond &bond : lost)
  {
    state.bonds.remove(bond.near, bond.kind);
    ++state.lost_bonds[bond.near];
    ++state.lost_bonds[bond.far];
  }
  return lost;
}

double Fracture::remove_bonds(State &state, const std::vector<std::pair<std::size_t, std::size_t>> &bonds)
{
  std::vector<BrokenBond> own;
  for (const auto &[place, kind] : std::set(bonds.begin(), bonds.end())) // two removed sites may have one in common
    if (band_.owns(place) && state.bonds.present(place, kind))
      own.push_back(broken(state, lattice_.bond(place, kind)));
  double removed_energy = 0.;
  for (const BrokenBond &bond : lose_bonds(state, own, nullptr))
    removed_energy += bond.energy;
  return removed_energy;
}

double Fracture::remove_sites(State &state, const std::vector<std::size_t> &places)
{
  std::vector<std::pair<std::size_t, std::size_t>> bonds; // place, kind
  for (const std::size_t place : places)
  {
    support::require(lattice_.is_site(place), "only a site can be removed");
    for_each_bond_of_site(state, lattice_, place, [&](const Bond &bond) { bonds.emplace_back(bond.near, bond.kind); });
  }
  const double removed_energy = remove_bonds(state, bonds);
  for (const std::size_t place : places)
  {
    state.removed[place] = 1;
    state.held[place] = state.rollers[place] = 0;
    state.inverse_mass[place] = 0.;
    for (VectorField *field : {&state.velocity, &state.acceleration})
      field->set(place, Eigen::Vector2d::Zero());
  }
  return removed_energy;
}

std::vector<BrokenBond> Fracture::apply(State &state, const Forces &forces, const VectorField &evaluated_velocity,
                                        int *number)
{
  if (state.breaking_stretch != breaking_stretch_ || state.toughened_stretch != toughened_stretch_ ||
      state.strength.empty() != material_.disorder.strength.is_none())
    throw std::logic_error("the breaking stretches of a state are set by configure() before bonds break");
  std::vector<BrokenBond> own;
  for (std::size_t row = band_.rows().begin; row < band_.rows().end; ++row)
    if (forces.row_sums(row).has_events)
      for_each_bond(state, lattice_, {row, row + 1},
                    [&](const Bond &bond)
                    {
                      const Event now = event(state, bond, evaluated_velocity, forces.lookahead());
                      if (now == Event::broken)
                        own.push_back(broken(state, bond));
                      else if (now == Event::retracted)
                        state.bonds.toughen(bond.near, bond.kind);
                    });
  std::vector<BrokenBond> lost = lose_bonds(state, own, number);

  const std::optional<std::size_t> previous_tip = tip_;
  if (tip_)
    tip_Y_before_ = lattice_.reference(*tip_).y();
  for (const BrokenBond &bond : lost)
  {
    consider_tip(state, bond.near);
    consider_tip(state, bond.far);
  }
  if (tip_ != previous_tip)
    toughen_behind_tip(state);
  return lost;
}

void Fracture::locate_tip(State &state)
{
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (lattice_.is_site(place))
      consider_tip(state, place);
  toughened_to_ = -std::numeric_limits<double>::infinity();
  toughen_behind_tip(state);
}

void Fracture::consider_tip(const State &state, std::size_t place)
{
  if (state.lost_bonds[place] < (material_.coordination(lattice_, place) + 3) / 4 || state.held[place] != 0 ||
      state.removed[place] != 0)
    return;
  const auto to_tip = [&](const Eigen::Vector2d &X) { return std::pair(-X.x(), std::abs(X.y() - tip_Y_before_)); };
  if (!tip_ || to_tip(lattice_.reference(place)) < to_tip(lattice_.reference(*tip_)))
    tip_ = place;
}

void Fracture::toughen_behind_tip(State &state)
{
  if (std::isinf(toughening_.distance) || !tip_)
    return;
  const double boundary = lattice_.reference(*tip_).x() - toughening_.distance;
  // The tip never retreats: bonds behind the last boundary are toughened already.
  double reach = 0.; // of midpoints from near ends on the grid, along X
  for (std::size_t kind = 0; kind < lattice_.n_kinds(); ++kind)
    reach = std::max(reach, 0.5 * std::abs(lattice_.bond_vector(kind).x()));
  reach += lattice_.grid().scatter.amplitude * lattice_.spacing();
  constexpr double endless = std::numeric_limits<double>::infinity();
  const auto [rows, columns] = lattice_.window({toughened_to_ - reach, -endless}, {boundary + reach, endless});
  const Rows own{std::max(rows.begin, band_.rows().begin), std::min(rows.end, band_.rows().end)};
  for (const std::size_t place : lattice_.sites(own, columns))
    for (std::size_t kind = 0; kind < state.bonds.n_kinds(); ++kind)
      if (state.bonds.present(place, kind) &&
          lattice_.reference(place).x() + 0.5 * lattice_.bond_vector(lattice_.bond(place, kind)).x() < boundary)
        state.bonds.toughen(place, kind);
  toughened_to_ = boundary;
}

std::optional<StretchedBond> Fracture::nearest_to_breaking(const State &state) const
{
  std::optional<StretchedBond> nearest;
  for_each_bond(state, lattice_,
                [&](const Bond &bond)
                {
                  const StretchedBond one{bond, stretch(state, lattice_, bond), limit(state, bond, 0.)};
                  if (!nearest || one.stretch / one.limit > nearest->stretch / nearest->limit)
                    nearest = one;
                });
  return nearest;
}

} // namespace latcon::lattice
