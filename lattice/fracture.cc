#include "lattice/fracture.h"

#include <cmath>
#include <stdexcept>

#include "lattice/instruction_sets.h"
#include "lattice/rows.h"

namespace lattice
{
namespace
{

void require(bool condition, const char *message)
{
  if (!condition)
    throw std::invalid_argument(message);
}

// Bonds of a row that are past their limit, or below `retraction` at their first limit, when their ends have gone on
// for `ahead` [s].
LATCON_PER_INSTRUCTION_SET double events_ahead(double ahead, double rest_length, double retraction, double first_limit,
                                               std::size_t n, const double *x, const double *y, const double *vx,
                                               const double *vy, const double *limit, std::ptrdiff_t shift)
{
  double events = 0.;
#pragma omp simd reduction(+ : events)
  for (std::size_t i = 0; i < n; ++i)
  {
    const double *const far_x = x + shift, *const far_y = y + shift;
    const double *const far_vx = vx + shift, *const far_vy = vy + shift;
    const double dx = (far_x[i] - x[i]) + ahead * (far_vx[i] - vx[i]);
    const double dy = (far_y[i] - y[i]) + ahead * (far_vy[i] - vy[i]);
    const double square = dx * dx + dy * dy, longest = limit[i] * rest_length, shortest = retraction * rest_length;
    // Nested selections instead of logical operators, which gcc would turn into branches.
    events += (limit[i] > 0. ? square : 0.) > longest * longest ? 1. : 0.;
    events += (limit[i] == first_limit ? square : shortest * shortest) < shortest * shortest ? 1. : 0.;
  }
  return events;
}

} // namespace

Fracture::Fracture(const TriangularLattice &lattice, const Material &material, double breaking_stretch,
                   Toughening toughening, const Eigen::Matrix2d &deformation)
  : lattice_(lattice), material_(material), breaking_stretch_(breaking_stretch), toughening_(toughening),
    tip_losses_((material.coordination() + 3) / 4)
{
  require(breaking_stretch > 0., "the breaking stretch must be positive");
  require(lattice.images().empty(), "a periodic sheet does not break: a crack has no tip there");
  if (const auto *behind = std::get_if<BehindTipToughening>(&toughening_))
    require(behind->distance >= 0. && behind->factor >= 1.,
            "toughening behind the tip needs distance >= 0, factor >= 1");
  if (const auto *retraction = std::get_if<RetractionToughening>(&toughening_))
  {
    require(retraction->fraction > 0. && retraction->fraction < 1. && retraction->factor >= 1.,
            "toughening on retraction needs a fraction between 0 and 1 and a factor >= 1");
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      retraction_stretch_[kind] =
        retraction->fraction * (deformation * lattice.bond_vector(kind)).norm() / lattice.rest_length(kind);
  }
}

void Fracture::watch(Forces &forces) const
{
  forces.watch_retraction(retraction_stretch_, breaking_stretch_);
}

void Fracture::look_ahead(double duration)
{
  require(duration >= 0., "breaking looks ahead in time, not back");
  look_ahead_ = duration;
  row_has_events_.assign(lattice_.rows(), 0);
}

void Fracture::find_rows_ahead(const State &state)
{
  for_each_row(lattice_,
               [&](std::size_t begin, std::size_t end)
               {
                 const std::size_t row = lattice_.row_of(begin);
                 double events = 0.;
                 for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
                   if (material_.shell(kind) != nullptr)
                     events +=
                       events_ahead(look_ahead_, lattice_.rest_length(kind), retraction_stretch_[kind],
                                    breaking_stretch_, end - begin, &state.x[begin], &state.y[begin], &state.vx[begin],
                                    &state.vy[begin], &state.breaking_stretch[kind][begin], lattice_.shift(kind, row));
                 row_has_events_[row] = events > 0. ? 1 : 0;
               });
}

double Fracture::stretch_ahead(const State &state, std::size_t place, std::size_t kind) const
{
  const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, lattice_.row_of(place)));
  return std::hypot((state.x[far] - state.x[place]) + look_ahead_ * (state.vx[far] - state.vx[place]),
                    (state.y[far] - state.y[place]) + look_ahead_ * (state.vy[far] - state.vy[place])) /
         lattice_.rest_length(kind);
}

double Fracture::bond_energy(const State &state, std::size_t place, std::size_t kind) const
{
  const Shell &shell = *material_.shell(kind);
  return cross_section(shell, lattice_) * lattice_.rest_length(kind) *
         energy(shell.law, stretch(state, lattice_, place, kind));
}

void Fracture::lose_bond(State &state, std::size_t place, std::size_t kind)
{
  const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, lattice_.row_of(place)));
  state.breaking_stretch[kind][place] = 0.;
  ++state.lost_bonds[place];
  ++state.lost_bonds[far];
}

double Fracture::remove_site(State &state, std::size_t place)
{
  require(lattice_.is_site(place), "only a site can be removed");
  double removed_energy = 0.;
  for_each_bond_of_site(state, lattice_, place,
                        [&](std::size_t near, std::size_t kind)
                        {
                          removed_energy += bond_energy(state, near, kind);
                          lose_bond(state, near, kind);
                        });
  state.removed[place] = 1;
  state.inverse_mass[place] = 0.;
  state.vx[place] = state.vy[place] = state.ax[place] = state.ay[place] = 0.;
  return removed_energy;
}

const std::vector<BrokenBond> &Fracture::apply(State &state, Forces &forces, const Field &evaluated_vx,
                                               const Field &evaluated_vy)
{
  broken_.clear();
  const auto *retraction = std::get_if<RetractionToughening>(&toughening_);
  if (look_ahead_ > 0.)
    find_rows_ahead(state);
  for (std::size_t row = 0; row < lattice_.rows(); ++row)
  {
    if (look_ahead_ > 0. ? row_has_events_[row] == 0 : !forces.row_has_events(row))
      continue;
    for (std::size_t column = 0; column < lattice_.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice_.index(row, column);
      for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      {
        double &limit = state.breaking_stretch[kind][place];
        if (!(limit > 0.))
          continue;
        const double current = stretch(state, lattice_, place, kind);
        const double decisive = look_ahead_ > 0. ? stretch_ahead(state, place, kind) : current;
        if (decisive > limit)
        {
          const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, row));
          const Eigen::Vector2d midpoint = lattice_.reference(place) + 0.5 * lattice_.bond_vector(kind);
          broken_.push_back({state.time, place, far, kind, midpoint, current, bond_energy(state, place, kind)});
        }
        else if (retraction != nullptr && limit == breaking_stretch_ && decisive < retraction_stretch_[kind])
          limit *= retraction->factor;
      }
    }
  }
  for (const BrokenBond &bond : broken_)
  {
    lose_bond(state, bond.near, bond.kind);
    forces.remove_bond(state, evaluated_vx, evaluated_vy, bond.near, bond.kind);
  }

  const std::optional<std::size_t> previous_tip = tip_;
  if (tip_)
    tip_y_ = lattice_.reference(*tip_).y();
  for (const BrokenBond &bond : broken_)
  {
    consider_tip(state, bond.near);
    consider_tip(state, bond.far);
  }
  if (tip_ != previous_tip)
    toughen_behind_tip(state);
  return broken_;
}

void Fracture::locate_tip(State &state)
{
  for (std::size_t row = 0; row < lattice_.rows(); ++row)
    for (std::size_t column = 0; column < lattice_.sites_in_row(row); ++column)
      consider_tip(state, lattice_.index(row, column));
  toughen_behind_tip(state);
}

void Fracture::consider_tip(const State &state, std::size_t place)
{
  if (state.lost_bonds[place] < tip_losses_ || state.held[place] != 0 || state.removed[place] != 0)
    return;
  const Eigen::Vector2d reference = lattice_.reference(place);
  if (tip_)
  {
    if (reference.x() < tip_x_)
      return;
    if (reference.x() == tip_x_)
    {
      const double rival = std::abs(lattice_.reference(*tip_).y() - tip_y_);
      if (!(std::abs(reference.y() - tip_y_) < rival))
        return;
    }
  }
  tip_ = place;
  tip_x_ = reference.x();
}

void Fracture::toughen_behind_tip(State &state)
{
  const auto *behind = std::get_if<BehindTipToughening>(&toughening_);
  if (behind == nullptr || !tip_)
    return;
  const double boundary = tip_x_ - behind->distance;
  for_each_bond(state, lattice_,
                [&](std::size_t place, std::size_t kind, std::size_t)
                {
                  double &limit = state.breaking_stretch[kind][place];
                  const double midpoint_x = lattice_.reference(place).x() + 0.5 * lattice_.bond_vector(kind).x();
                  if (limit == breaking_stretch_ && midpoint_x < boundary)
                    limit *= behind->factor;
                });
}

} // namespace lattice
