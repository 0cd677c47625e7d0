#include "verification/bridge/homogeneous_response.h"

#include <cmath>

#include "lattice/forces.h"
#include "lattice/site_fields.h"

namespace latcon::bridge
{

Eigen::Matrix2d edge_stress(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                            const std::function<Eigen::Vector2d(std::size_t)> &force_on)
{
  const auto force = [&](std::size_t row, std::size_t column) { return force_on(sheet.index(row, column)); };
  // The forces on the two uppermost rows balance the rest of the sheet: they are P times the normal, per length d of a
  // column. The same applies to the left end, where sites with missing neighbours repeat every two rows.
  const std::size_t top = sheet.rows() - 1, column = sheet.columns() / 2, row = 2 * (sheet.rows() / 4);
  const double d = sheet.spacing();
  const Eigen::Vector2d across = -(force(top, column) + force(top - 1, column)) / d;
  Eigen::Vector2d ends = force(row, 0) + force(row, 1) + force(row + 1, 0);
  if (material.third_nearest) // their bonds along a row reach farther than 1.5 d
    ends += force(row + 1, 1);
  const Eigen::Vector2d along = ends / (std::sqrt(3.) * d);

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
