#include <cmath>
#include <type_traits>
#include <variant>

#include "lattice/forces.h"

// Forces of a bond and on a site, by the operations of an evaluation of all (forces.cc), so that both have the same
// bits.
namespace latcon::lattice
{

kernels::BondForce kernels::bond_force(const BondLaw &law, const BondConstants &bond, double factor, double dx,
                                       double dy, double dvx, double dvy, double length_ratio)
{
  dx *= length_ratio;
  dy *= length_ratio;
  const double distance = std::sqrt(dx * dx + dy * dy);
  const double inverse = 1. / distance;
  const double nx = length_ratio * (dx * inverse), ny = length_ratio * (dy * inverse);
  const double rate = dvx * nx + dvy * ny;
  const double stretch = (1. / bond.rest_length) * distance;
  const double viscous = bond.damping * rate;
  const double axial =
    factor * (bond.cross_section * std::visit([&](const auto &of_kind)
                                              { return formulas::force(of_kind, stretch, bond.rest_length * inverse); },
                                              law) +
              viscous);
  return {axial * nx, axial * ny, nx, ny, stretch, factor * (viscous * rate)};
}

void Forces::remove_bond(const State &state, const Field &vx, const Field &vy, const Bond &bond)
{
  if (!band_.owns(bond.near))
    return;
  const std::size_t row = lattice_.row_of(bond.near), shell = lattice_.shell(bond.kind);
  const auto [force, dissipation] = single_bond({state, vx, vy}, bond);
  row_viscous_power_[row] -= force.viscous_power;
  for (std::size_t m = 0; m < n_mechanisms(memories_[shell]); ++m)
    row_mechanism_power_[first_mechanism_[shell] + m][row] -= dissipation[m];
}

Forces::SingleBond Forces::single_bond(const Motion &motion, const Bond &bond) const
{
  const State &state = motion.state;
  const Field &vx = motion.vx, &vy = motion.vy;
  const auto [near, kind, far] = bond;
  const kernels::BondConstants &constants = constants_[kind];
  const double factor = state.stiffness.of(near, kind);
  SingleBond single{kernels::bond_force(laws_[lattice_.shell(kind)], constants, factor, state.x[far] - state.x[near],
                                        state.y[far] - state.y[near], vx[far] - vx[near], vy[far] - vy[near],
                                        lattice_.length_ratio(near, kind)),
                    {}};
  if (!state.history.remembers(kind))
    return single;
  std::array<double, max_history_variables> variables{};
  state.history.variables_of(near, kind, variables.data());
  const double before = state.history.kinds[kind].stretch[near];
  const MemoryStep &step = memory_steps_[lattice_.shell(kind)];
  const auto overstress = [&](const auto &s) -> double
  {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, NoMemory::Step>)
      return 0.;
    else
      return formulas::advance(s, before, single.force.stretch, variables.data(), single.dissipation.data());
  };
  const double axial = constants.cross_section * std::visit(overstress, step) * factor;
  single.force.x += axial * single.force.nx;
  single.force.y += axial * single.force.ny;
  for (double &power : single.dissipation)
  {
    power = power * (constants.cross_section * constants.rest_length) * factor;
    if (!dissipates_energy(step))
      single.force.viscous_power += power;
  }
  return single;
}

Eigen::Vector2d Forces::on_site(const State &state, const Field &vx, const Field &vy, std::size_t place) const
{
  const auto force = [&](const Bond &bond) -> Eigen::Vector2d
  {
    if (!state.bonds.present(bond.near, bond.kind))
      return {0., 0.};
    const kernels::BondForce of_bond = single_bond({state, vx, vy}, bond).force;
    return {of_bond.x, of_bond.y};
  };
  Eigen::Vector2d sum(0., 0.);
  if (!lattice_.is_triangular())
  {
    // In the order of an evaluation: rows from the lowest up, half-bond by half-bond.
    for (std::ptrdiff_t below = reach_; below >= 0; --below)
      for (std::size_t kind = 0; kind < n_kinds_; ++kind)
      {
        if (below == 0)
          sum += force(lattice_.bond(place, kind));
        if (lattice_.rows_across(kind) == below)
          sum -= force(lattice_.bond_into(place, kind));
      }
    return sum;
  }
  std::array<std::array<double, n_bond_kinds>, 2> start{}, end{};
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    const Eigen::Vector2d from = force(lattice_.bond(place, kind)), into = force(lattice_.bond_into(place, kind));
    for (std::size_t c = 0; c < 2; ++c)
    {
      start[c][kind] = from[static_cast<Eigen::Index>(c)];
      end[c][kind] = into[static_cast<Eigen::Index>(c)];
    }
  }
  const auto component = [&](std::size_t c)
  {
    return n_kinds_ == n_bond_kinds ? formulas::sum_of_bonds<true>(start[c], end[c])
                                    : formulas::sum_of_bonds<false>(start[c], end[c]);
  };
  return {component(0), component(1)};
}

} // namespace latcon::lattice
