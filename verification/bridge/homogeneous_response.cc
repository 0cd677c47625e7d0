#include "verification/bridge/homogeneous_response.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "lattice/forces.h"
#include "lattice/site_fields.h"
#include "support/largest_error.h"
#include "verification/bridge/plane_waves.h"

namespace latcon::bridge
{
namespace
{

// The bound is that of the harmonics from number `first` on.
RotationMean mean_of_period(const Eigen::MatrixXd &values, int n, int first)
{
  if (values.cols() != n)
    throw std::invalid_argument("a mean over a period needs one column of values per rotation or direction");
  const Eigen::VectorXd mean = values.rowwise().mean();
  const Eigen::MatrixXd rest = values.colwise() - mean; // the harmonics would be lost in the round-off of the mean
  double bound = 0.;
  for (int j = first; j <= n - first; ++j)
  {
    Eigen::VectorXcd harmonic = Eigen::VectorXcd::Zero(rest.rows());
    for (int k = 0; k < n; ++k)
      harmonic += std::polar(1. / n, -2. * M_PI * (j * k % n) / n) * rest.col(k);
    bound += harmonic.norm();
  }
  return {mean, bound};
}

} // namespace

Eigen::Matrix2d edge_stress(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                            const std::function<Eigen::Vector2d(std::size_t)> &force_on)
{
  const auto force = [&](std::size_t row, std::size_t column) { return force_on(sheet.index(row, column)); };
  // The forces on the uppermost rows, as many as bonds reach, balance the rest of the sheet: they are P times the
  // normal, per length h of a column. The same applies to the left end, where sites with missing neighbours repeat
  // every row, every two rows on a triangular grid.
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
    reach = support::largest_of({reach, std::abs(sheet.bond_vector(kind).dot(unit)) / h});
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
  forces.evaluate(state, state.velocity);
  const Eigen::Matrix2d P =
    edge_stress(sheet, material, [&](std::size_t place) { return forces.on_sites().at(place); });
  const std::size_t middle = sheet.index(2 * (sheet.rows() / 4), sheet.columns() / 2);
  return {lattice::site_values(state, sheet, material, middle).strain_energy_density, P};
}

Eigen::Matrix2d lattice_rotation(int k)
{
  return Eigen::Rotation2Dd(M_PI / 3. * k / n_lattice_rotations).toRotationMatrix();
}

RotationMean rotation_mean(const Eigen::MatrixXd &values)
{
  return mean_of_period(values, n_lattice_rotations, 1);
}

Eigen::MatrixXd rotated_bloch_stiffness(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                        const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  Eigen::MatrixXd matrices(4, n_lattice_rotations);
  for (int k = 0; k < n_lattice_rotations; ++k)
  {
    const Eigen::Matrix2d R = lattice_rotation(k);
    matrices.col(k) = bloch_matrices(lattice, material, F * R, R.transpose() * K).stiffness.reshaped();
  }
  return matrices;
}

Eigen::Vector2d bond_direction(int k)
{
  const double angle = M_PI * k / n_bond_directions;
  return {std::cos(angle), std::sin(angle)};
}

RotationMean direction_mean(const Eigen::MatrixXd &values)
{
  return mean_of_period(values, n_bond_directions, 3);
}

} // namespace latcon::bridge
