#include "lattice/forces.h"

// Forces of a bond and on a site, by the operations of an evaluation of all (forces.cc), so that both have the same bits.
namespace latcon::lattice
{

void Forces::remove_bond(const State &state, const Field &vx, const Field &vy, const Bond &bond)
{
  if (!band_.owns(bond.near))
    return;
  const std::size_t row = lattice_.row_of(bond.near), shell = lattice_.shell(bond.kind);
  const kernels::BondForce force = single_bond({state, vx, vy}, bond);
  row_viscous_power_[row] -= force.viscous_power;
  if (!state.history.remembers(bond.kind))
    return;
  const kernels::Overstress over = overstress(state, bond, force.stretch);
  for (std::size_t m = 0; m < n_mechanisms(memories_[shell]); ++m)
    row_mechanism_power_[first_mechanism_[shell] + m][row] -= over.dissipation[m];
}

kernels::Overstress Forces::overstress(const State &state, const Bond &bond, double stretch) const
{
  kernels::Overstress over =
    kernels::overstress(memory_steps_[lattice_.shell(bond.kind)], constants_[bond.kind], stretch, bond.near,
                        kernels::remembered_from<const double *>(state.history.kinds[bond.kind], 0));
  const double factor = state.stiffness.of(bond.near, bond.kind);
  over.axial *= factor;
  for (double &power : over.dissipation)
    power *= factor;
  return over;
}

kernels::BondForce Forces::single_bond(const Motion &motion, const Bond &bond) const
{
  const State &state = motion.state;
  const Field &vx = motion.vx, &vy = motion.vy;
  const auto [near, kind, far] = bond;
  kernels::BondForce force = kernels::bond_force(
    laws_[lattice_.shell(kind)], constants_[kind], state.stiffness.of(near, kind), state.x[far] - state.x[near],
    state.y[far] - state.y[near], vx[far] - vx[near], vy[far] - vy[near], lattice_.length_ratio(near, kind));
  if (state.history.remembers(kind))
  {
    const kernels::Overstress over = overstress(state, bond, force.stretch);
    force.x += over.axial * force.nx;
    force.y += over.axial * force.ny;
    if (!dissipates_energy(memory_steps_[lattice_.shell(kind)]))
      for (const double power : over.dissipation)
        force.viscous_power += power;
  }
  return force;
}

// In the order of an evaluation: rows from the lowest up, half-bond by half-bond.
Eigen::Vector2d Forces::on_site_of_stencil(const Motion &motion, std::size_t place) const
{
  Eigen::Vector2d sum(0., 0.);
  const auto add = [&](double sign, const Bond &bond)
  {
    if (!motion.state.bonds.present(bond.near, bond.kind))
      return;
    const kernels::BondForce force = single_bond(motion, bond);
    sum += sign * Eigen::Vector2d(force.x, force.y);
  };
  for (std::ptrdiff_t below = reach_; below >= 0; --below)
    for (std::size_t kind = 0; kind < n_kinds_; ++kind)
    {
      if (below == 0)
        add(1., lattice_.bond(place, kind));
      if (lattice_.rows_across(kind) == below)
        add(-1., lattice_.bond_into(place, kind));
    }
  return sum;
}

Eigen::Vector2d Forces::on_site(const State &state, const Field &vx, const Field &vy, std::size_t place) const
{
  if (!lattice_.is_triangular())
    return on_site_of_stencil({state, vx, vy}, place);
  std::array<std::array<double, n_bond_kinds>, 2> start{}, end{};
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    const auto note = [&](const Bond &bond, auto &of_kind)
    {
      if (!state.bonds.present(bond.near, kind))
        return;
      const kernels::BondForce force = single_bond({state, vx, vy}, bond);
      of_kind[0][kind] = force.x;
      of_kind[1][kind] = force.y;
    };
    note(lattice_.bond(place, kind), start);
    note(lattice_.bond_into(place, kind), end);
  }
  const auto sum = [&](std::size_t component)
  {
    return n_kinds_ == n_bond_kinds ? sum_of_bonds<true>(start[component], end[component])
                                    : sum_of_bonds<false>(start[component], end[component]);
  };
  return {sum(0), sum(1)};
}

} // namespace latcon::lattice
