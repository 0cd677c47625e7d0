#include "lattice/forces.h"

#include <algorithm>
#include <cmath>

#include <omp.h>

#include "lattice/instruction_sets.h"

namespace lattice
{
namespace
{

// A bond's force where it is computed, in the loop over a row and for a single bond: so both have the same bits.
template <class Law>
inline Forces::BondForce bond_force(const Law &law, const Forces::Bond &bond, double breaking_stretch, double dx,
                                    double dy, double dvx, double dvy)
{
  const double distance = std::sqrt(dx * dx + dy * dy);
  // An absent bond has no direction, hence no force; one selection here is far cheaper than one for each result.
  const double inverse = breaking_stretch > 0. ? 1. / distance : 0.;
  const double nx = dx * inverse;
  const double ny = dy * inverse;
  const double rate = dvx * nx + dvy * ny;
  const double stretch = distance * (1. / bond.rest_length);
  const double viscous = bond.damping * rate;
  const double axial = bond.cross_section * law.force(stretch, bond.rest_length * inverse) + viscous;
  return {axial * nx, axial * ny, stretch, viscous * rate};
}

struct RowOfBonds
{
  std::size_t n;
  const double *x, *y, *vx, *vy;                 // near ends
  const double *far_x, *far_y, *far_vx, *far_vy; // far ends
  const double *breaking_stretch;
  double initial_breaking_stretch;
  double *fx, *fy;
};

template <class Law, bool watches_retraction>
LATCON_PER_INSTRUCTION_SET Forces::RowSums evaluate_bonds(const Law law, const Forces::Bond bond, const RowOfBonds &row)
{
  // Locals, since a store through fx might otherwise change what `row` refers to.
  const std::size_t n = row.n;
  const double *const x = row.x, *const y = row.y, *const vx = row.vx, *const vy = row.vy;
  const double *const far_x = row.far_x, *const far_y = row.far_y;
  const double *const far_vx = row.far_vx, *const far_vy = row.far_vy;
  const double *const breaking_stretch = row.breaking_stretch;
  const double initial_breaking_stretch = row.initial_breaking_stretch;
  double *__restrict const fx = row.fx;
  double *__restrict const fy = row.fy;

  double power = 0.;
  double events = 0.;
#pragma omp simd reduction(+ : power, events)
  for (std::size_t i = 0; i < n; ++i)
  {
    const double limit = breaking_stretch[i];
    const Forces::BondForce force =
      bond_force(law, bond, limit, far_x[i] - x[i], far_y[i] - y[i], far_vx[i] - vx[i], far_vy[i] - vy[i]);
    fx[i] = force.x;
    fy[i] = force.y;
    power += force.viscous_power;
    // Nested selections instead of logical operators, which gcc would turn into branches.
    events += (limit > 0. ? force.stretch : 0.) > limit ? 1. : 0.;
    if constexpr (watches_retraction)
      events += (limit == initial_breaking_stretch ? force.stretch : bond.retraction_stretch) < bond.retraction_stretch
                  ? 1.
                  : 0.;
  }
  return {power, events};
}

// Force on a site from the bonds of each kind: those that start there, less those that end there.
// Pairs that a mirror exchanges are added first: exchanging the terms of a sum of two leaves its bits as they are.
// Twelve numbers and no arrays, from which gcc would make no vectors.
inline double sum_of_bonds(double start_0, double start_1, double start_2, double start_3, double start_4,
                           double start_5, double end_0, double end_1, double end_2, double end_3, double end_4,
                           double end_5)
{
  return ((start_0 - end_0) + (start_5 - end_5)) +
         (((start_1 - end_2) + (start_2 - end_1)) + ((start_3 - end_4) + (start_4 - end_3)));
}

using BondsOfKinds = std::array<const double *, n_bond_kinds>;

LATCON_PER_INSTRUCTION_SET void gather_bonds(std::size_t n, const BondsOfKinds start, const BondsOfKinds end,
                                             double *__restrict total)
{
  const double *const s0 = start[0], *const s1 = start[1], *const s2 = start[2];
  const double *const s3 = start[3], *const s4 = start[4], *const s5 = start[5];
  const double *const e0 = end[0], *const e1 = end[1], *const e2 = end[2];
  const double *const e3 = end[3], *const e4 = end[4], *const e5 = end[5];
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i)
    total[i] = sum_of_bonds(s0[i], s1[i], s2[i], s3[i], s4[i], s5[i], e0[i], e1[i], e2[i], e3[i], e4[i], e5[i]);
}

} // namespace

Forces::Forces(const RowBand &band, const Material &material)
  : band_(band), lattice_(band.lattice()), rows_repeat_(lattice_.is_occupied(lattice_.index(0, 0) - lattice_.stride())),
    columns_repeat_(lattice_.is_occupied(lattice_.index(0, 0) - 1)), fx_(lattice_.n_places()), fy_(lattice_.n_places()),
    row_viscous_power_(lattice_.rows(), 0.), row_events_(lattice_.rows(), 0.)
{
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
  {
    const Shell *shell = material.shell(kind);
    const double rest_length = lattice_.rest_length(kind);
    const double section = shell != nullptr ? cross_section(*shell, lattice_) : 0.;
    const double viscosity = shell != nullptr ? shell->viscosity : 0.;
    shells_[kind] = shell;
    kinds_[kind] = {rest_length, section, section * viscosity / rest_length};
  }
}

void Forces::watch_retraction(const std::array<double, n_bond_kinds> &stretch, double initial_breaking_stretch)
{
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    kinds_[kind].retraction_stretch = stretch[kind];
  initial_breaking_stretch_ = initial_breaking_stretch;
}

void Forces::evaluate(const State &state, const Field &vx, const Field &vy)
{
  const bool threads = lattice_.n_places() >= worth_threads;
  bond_rows_.resize(threads ? static_cast<std::size_t>(omp_get_max_threads()) : 1, BondRows(lattice_.stride()));
#pragma omp parallel if (threads)
  {
    const auto first = static_cast<std::ptrdiff_t>(band_.rows().begin);
    const auto rows = static_cast<std::ptrdiff_t>(band_.rows().end) - first;
    const std::ptrdiff_t n = omp_get_num_threads(), i = omp_get_thread_num();
    evaluate_rows({state, vx, vy}, first + rows * i / n, first + rows * (i + 1) / n,
                  bond_rows_[static_cast<std::size_t>(i)]);
  }
}

double Forces::viscous_power() const
{
  double sum = 0.;
  for (const double power : row_viscous_power_)
    sum += power;
  return sum;
}

void Forces::evaluate_rows(const Motion &motion, std::ptrdiff_t begin, std::ptrdiff_t end, BondRows &bonds)
{
  if (begin == end)
    return;
  bonds_from_below(motion, begin - 2, bonds);
  bonds_from_below(motion, begin - 1, bonds);
  for (std::ptrdiff_t row = begin; row < end; ++row)
  {
    const auto index = static_cast<std::size_t>(row);
    const RowSums sums = bonds_of_row(motion, index, row, bonds);
    row_viscous_power_[index] = sums.viscous_power;
    row_events_[index] = sums.events;
    gather_row(row, bonds);
  }
}

void Forces::bonds_from_below(const Motion &motion, std::ptrdiff_t row, BondRows &bonds) const
{
  if (row >= 0)
    bonds_of_row(motion, static_cast<std::size_t>(row), row, bonds);
  else if (rows_repeat_)
    bonds_of_row(motion, lattice_.rows() - static_cast<std::size_t>(-row), row, bonds);
  else
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      for (std::size_t component = 0; component < 2; ++component)
        std::fill_n(bonds.at(row, kind, component) - 2, lattice_.stride(), 0.);
}

// The bonds of row `from` as those of `row`: the same, or below the edge of a periodic sheet.
Forces::RowSums Forces::bonds_of_row(const Motion &motion, std::size_t from, std::ptrdiff_t row, BondRows &bonds) const
{
  RowSums total;
  const std::size_t columns = lattice_.columns(), near = lattice_.index(from, 0);
  const State &state = motion.state;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
  {
    if (shells_[kind] == nullptr)
      continue;
    const Bond &bond = kinds_[kind];
    const std::size_t far = near + static_cast<std::size_t>(lattice_.shift(kind, from));
    double *const fx = bonds.at(row, kind, 0), *const fy = bonds.at(row, kind, 1);
    const RowOfBonds all{columns,
                         &state.x[near],
                         &state.y[near],
                         &motion.vx[near],
                         &motion.vy[near],
                         &state.x[far],
                         &state.y[far],
                         &motion.vx[far],
                         &motion.vy[far],
                         &state.breaking_stretch[kind][near],
                         initial_breaking_stretch_,
                         fx,
                         fy};
    const RowSums sums = std::visit(
      [&](auto law)
      {
        using Law = decltype(law);
        return bond.retraction_stretch > 0. ? evaluate_bonds<Law, true>(law, bond, all)
                                            : evaluate_bonds<Law, false>(law, bond, all);
      },
      shells_[kind]->law);
    total.viscous_power += sums.viscous_power;
    total.events += sums.events;
    // A site gathers from the places around it, so bonds that start beyond a periodic edge must be there.
    if (columns_repeat_)
      for (double *force : {fx, fy})
      {
        std::copy_n(force, 2, force + columns);
        std::copy_n(force + columns - 2, 2, force - 2);
      }
  }
  return total;
}

void Forces::gather_row(std::ptrdiff_t row, BondRows &bonds)
{
  const auto index = static_cast<std::size_t>(row);
  for (std::size_t component = 0; component < 2; ++component)
  {
    BondsOfKinds start, end;
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      start[kind] = bonds.at(row, kind, component);
    end[0] = start[0] - 1;
    end[5] = bonds.at(row - 2, 5, component);
    // The others come from a row of the other parity, where the same shift leads from the site's column to their start.
    for (std::size_t kind = 1; kind < 5; ++kind)
      end[kind] = bonds.at(row - 1, kind, component) + static_cast<std::ptrdiff_t>(lattice_.stride()) -
                  lattice_.shift(kind, index + 1);
    gather_bonds(lattice_.columns(), start, end, &(component == 0 ? fx_ : fy_)[lattice_.index(index, 0)]);
  }
}

void Forces::remove_bond(const State &state, const Field &vx, const Field &vy, std::size_t place, std::size_t kind)
{
  const Motion motion{state, vx, vy};
  const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, lattice_.row_of(place)));
  constexpr double present = 1.; // it no longer is by its limit
  if (band_.owns(place))
    row_viscous_power_[lattice_.row_of(place)] -= single_bond(motion, place, kind, present).viscous_power;
  // Subtracting from the totals would leave round-off that depends on the order of breaking.
  for (const std::size_t end : {place, lattice_.home(far)})
    if (band_.owns(end))
      sum_site(motion, end);
}

Forces::BondForce Forces::single_bond(const Motion &motion, std::size_t place, std::size_t kind,
                                      double breaking_stretch) const
{
  const State &state = motion.state;
  const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, lattice_.row_of(place)));
  return std::visit(
    [&](const auto &law)
    {
      return bond_force(law, kinds_[kind], breaking_stretch, state.x[far] - state.x[place],
                        state.y[far] - state.y[place], motion.vx[far] - motion.vx[place],
                        motion.vy[far] - motion.vy[place]);
    },
    shells_[kind]->law);
}

void Forces::sum_site(const Motion &motion, std::size_t place)
{
  const std::size_t row = lattice_.row_of(place);
  std::array<BondForce, n_bond_kinds> s{}, e{};
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
  {
    const Field &breaking_stretch = motion.state.breaking_stretch[kind];
    // As in gather_row, along the row and two rows down the parity is the site's own.
    const std::size_t near_row = (kind == 0 || kind == 5) ? row : row + 1;
    const std::size_t near = lattice_.home(place - static_cast<std::size_t>(lattice_.shift(kind, near_row)));
    if (breaking_stretch[place] > 0.)
      s[kind] = single_bond(motion, place, kind, breaking_stretch[place]);
    if (breaking_stretch[near] > 0.)
      e[kind] = single_bond(motion, near, kind, breaking_stretch[near]);
  }
  fx_[place] =
    sum_of_bonds(s[0].x, s[1].x, s[2].x, s[3].x, s[4].x, s[5].x, e[0].x, e[1].x, e[2].x, e[3].x, e[4].x, e[5].x);
  fy_[place] =
    sum_of_bonds(s[0].y, s[1].y, s[2].y, s[3].y, s[4].y, s[5].y, e[0].y, e[1].y, e[2].y, e[3].y, e[4].y, e[5].y);
}

} // namespace lattice
