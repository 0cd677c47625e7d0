#include "verification/bridge/homogeneous_response.h"

#include <algorithm>
#include <cmath>

#include "lattice/forces.h"
#include "lattice/site_fields.h"

namespace latcon::bridge
{

Eigen::Matrix2d edge_stress(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                            const std::function<Eigen::Vector2d(std::size_t)> &force_on)
{
  const auto force = [&](std::size_t row, std::size_t column) { return force_on(sheet.index(row, column)); };
  // The forces on the uppermost rows, as many as bonds reach, balance the rest of the sheet: they are P times the
  // normal, per length h of a column. The same applies to the left end, where sites with missing neighbours repeat every
  // row, every two rows on a triangular grid.
  const double h = sheet.spacing();
  const std::size_t top = sheet.rows() - 1, column = sheet.columns() / 2, row = 2 * (sheet.rows() / 4);
  Eigen::Vector2d across = Eigen::Vector2d::Zero(), ends = across;
  for (std::size_t below = 0; below < sheet.reach(); ++below)
    across += force(top - below, column);
  across /= -h;

  const bool is_triangular = sheet.grid().kind == lattice::Grid::Kind::triangular;
  const Eigen::Vector2d unit = sheet.grid().from_row_frame(1., 0.) / h;
  double reach = 0.; // along rows, in spacings
  for (std::size_t kind = 0; kind < material.n_kinds(sheet); ++kind)
    reach = std::max(reach, std::abs(sheet.bond_vector(kind).dot(unit)) / h);
  const std::size_t period = is_triangular ? 2 : 1;
  for (std::size_t odd = 0; odd < period; ++odd)
    for (std::size_t at = 0; static_cast<double>(at) + 0.5 * static_cast<double>(odd) < reach - 1e-9; ++at)
      ends += force(row + odd, at);
  const Eigen::Vector2d along = ends / (is_triangular ? std::sqrt(3.) * h : h);

  const bool rows_along_x = sheet.orientation() == lattice::Orientation::rows_along_crack;
  Eigen::Matrix2d P;
  P.col(rows_along_x ? 0 : 1) = along;
  P.col(rows_along_x ? 1 : 0) = across;
  return P;
}

LatticeResponse homogeneous_response(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                     const Eigen::Matrix2d &F)
{
  const lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  lattice::Forces forces(sheet, material);
  forces.evaluate(state, state.vx, state.vy);
  const Eigen::Matrix2d P = edge_stress(
    sheet, material, [&](std::size_t place) { return Eigen::Vector2d(forces.fx()[place], forces.fy()[place]); });
  const lattice::SiteFields fields = lattice::site_fields(state, sheet, material);
  return {fields.strain_energy_density[sheet.index(2 * (sheet.rows() / 4), sheet.columns() / 2)], P};
}

} // namespace latcon::bridge
