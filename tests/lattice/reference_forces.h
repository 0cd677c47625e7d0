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

/// @param retraction_stretch as in Forces::set_retraction_threshold
inline ReferenceForces
reference_forces(const latcon::lattice::State &state, const latcon::lattice::TriangularLattice &sheet,
                 const latcon::lattice::Material &material,
                 const std::array<double, latcon::lattice::n_bond_kinds> &retraction_stretch = {})
{
  using Eigen::Vector2d;
  const latcon::lattice::Field zero(sheet.n_places(), 0.);
  ReferenceForces result{zero, zero, zero, 0., std::vector<bool>(sheet.rows(), false)};
  const auto visit = [&](std::size_t near, std::size_t kind, std::size_t far)
  {
    const latcon::lattice::Shell &shell = *material.shell(kind);
    const double section = cross_section(shell, sheet), rest_length = sheet.rest_length(kind);
    const Vector2d bond(state.x[far] - state.x[near], state.y[far] - state.y[near]);
    const Vector2d velocity(state.vx[far] - state.vx[near], state.vy[far] - state.vy[near]);
    const double stretch = bond.norm() / rest_length;
    const double rate = velocity.dot(bond.normalized());
    const double axial = section * (force(shell.law, stretch) + shell.viscosity * rate / rest_length);
    const Vector2d on_near = axial * bond.normalized();
    // Terms of opposite sign may cancel within a bond too: in its law, where the tangent at rest and the stretch bound
    // them, and in the rate.
    const double magnitude = section * (2. * stiffness(shell.law, 1.) * std::max(stretch, std::pow(stretch, -3)) +
                                        shell.viscosity * velocity.norm() / rest_length);
    for (const auto &[place, sense] : {std::pair{near, 1.}, std::pair{sheet.home(far), -1.}})
    {
      result.fx[place] += sense * on_near.x();
      result.fy[place] += sense * on_near.y();
      result.magnitude[place] += magnitude;
    }
    result.viscous_power += section * shell.viscosity * rate * rate / rest_length;
    if (stretch > limit(state, near, kind) ||
        (!state.bonds.toughened(near, kind) && stretch < retraction_stretch[kind]))
      result.row_has_events[sheet.row_of(near)] = true;
  };
  for_each_bond(state, sheet, visit);
  return result;
}
