#pragma once

#include <cmath>
#include <vector>

#include "lattice/state.h"

/// The forces of theory.md, eq. (L.3), bond by bond and in no hurry: what the hot loop is measured against.
struct ReferenceForces
{
  latcon::lattice::Field fx, fy;    // [N/m], one a place; zero at images, whose share goes to their sites
  latcon::lattice::Field magnitude; // sum of the absolute values of all terms that add up to a site's force [N/m]
  double viscous_power = 0.;        // [W/m]
  std::vector<bool> row_has_events;
};

/// Stretch beyond which a bond that is present may break [-]; see BreakingRule::smallest_limit().
inline double breaking_stretch_of(const latcon::lattice::State &state, const latcon::lattice::Bond &bond)
{
  return (state.bonds.toughened(bond.near, bond.kind) ? state.toughened_stretch : state.breaking_stretch) *
         state.strength.of(bond.near, bond.kind);
}

/// Maxwell branches of a bond: {overstress after a sudden change to `stretch` [Pa], modulus [Pa], relaxation time [s]}.
inline std::vector<std::array<double, 3>> overstressed_branches(const latcon::lattice::State &state,
                                                                const latcon::lattice::Shell &shell, std::size_t place,
                                                                std::size_t kind, double stretch)
{
  std::vector<std::array<double, 3>> branches;
  if (const auto *memory = std::get_if<latcon::lattice::MaxwellMemory>(&shell.memory))
    for (std::size_t i = 0; i < memory->branches().size(); ++i)
    {
      const latcon::lattice::BondHistory::Kind &history = state.history.kinds[kind];
      const auto &[modulus, time] = memory->branches()[i];
      branches.push_back({history.variables[i][place] + modulus * (stretch - history.stretch[place]), modulus, time});
    }
  return branches;
}

/// @param retraction_stretch as in Forces::set_retraction_threshold
inline ReferenceForces
reference_forces(const latcon::lattice::State &state, const latcon::lattice::TriangularLattice &sheet,
                 const latcon::lattice::Material &material,
                 const std::vector<double> &retraction_stretch = std::vector<double>(latcon::lattice::n_bond_kinds))
{
  using Eigen::Vector2d;
  const latcon::lattice::Field zero(sheet.n_places(), 0.);
  ReferenceForces result{zero, zero, zero, 0., std::vector<bool>(sheet.rows(), false)};
  const auto visit = [&](const latcon::lattice::Bond &bond)
  {
    const auto [near, kind, far] = bond;
    const latcon::lattice::Shell &shell = *material.shell(kind);
    const double section = state.stiffness.of(near, kind) * cross_section(shell, sheet);
    const double rest_length = sheet.rest_length(kind);
    const Vector2d r = state.position.difference(near, far);
    const std::size_t moving = sheet.canonical_place(far);
    const Vector2d velocity = state.velocity.difference(near, moving);
    const double stretch = r.norm() / rest_length;
    const double rate = velocity.dot(r.normalized());
    const double axial = section * (force(shell.law, stretch) + shell.viscosity * rate / rest_length);
    // theory.md, eq. (L.27), no time having passed since the update.
    double over = 0., over_magnitude = 0., dissipation = 0.;
    for (const auto &[q, modulus, time] : overstressed_branches(state, shell, near, kind, stretch))
    {
      over += q;
      over_magnitude += std::abs(q) + 2. * modulus * stretch; // terms of a branch may cancel
      dissipation += q * q / (modulus * time);
    }
    const Vector2d on_near = (axial + section * over) * r.normalized();
    // Terms of opposite sign may cancel within a bond too: in its law, where the tangent at rest and the stretch bound
    // them, and in the rate.
    const double magnitude = section * (2. * stiffness(shell.law, 1.) * std::max(stretch, std::pow(stretch, -3)) +
                                        shell.viscosity * velocity.norm() / rest_length) +
                             over_magnitude * section;
    for (const auto &[place, sense] : {std::pair{near, 1.}, std::pair{sheet.canonical_place(far), -1.}})
    {
      result.fx[place] += sense * on_near.x();
      result.fy[place] += sense * on_near.y();
      result.magnitude[place] += magnitude;
    }
    result.viscous_power += section * shell.viscosity * rate * rate / rest_length + section * rest_length * dissipation;
    if (stretch > breaking_stretch_of(state, bond) ||
        (!state.bonds.toughened(near, kind) && stretch < retraction_stretch[kind]))
      result.row_has_events[sheet.row_of(near)] = true;
  };
  for_each_bond(state, sheet, visit);
  return result;
}
