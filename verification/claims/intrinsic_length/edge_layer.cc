#include "verification/claims/intrinsic_length/edge_layer.h"

#include <cmath>

#include "lattice/relaxation.h"

namespace latcon::claims
{

EdgeLayer relaxed_edge(double spacing, const lattice::Material &material, double stretch, std::size_t rows)
{
  const double pitch = std::sqrt(3.) / 2. * spacing;
  const lattice::TriangularLattice sheet(spacing, 4. * spacing, 4. * static_cast<double>(rows) * pitch,
                                         lattice::Orientation::rows_along_crack, {true, false});
  Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  F(0, 0) = stretch;
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  // Forces are sums of up to eighteen of the order of section times modulus; 1e-13 of them is a deviation of as much.
  const double scale = lattice::cross_section(material.nearest, sheet) * lattice::stiffness(material.nearest.law, 1.);
  const lattice::Relaxation relaxation = lattice::relax(state, sheet, material, 1e-13 * scale);

  // The mean over a row: sites of one row stay level.
  const auto level = [&](std::size_t row)
  {
    double y = 0.;
    for (std::size_t column = 0; column < sheet.columns(); ++column)
      y += state.y[sheet.index(row, column)] / static_cast<double>(sheet.columns());
    return y;
  };
  const std::size_t top = sheet.rows() - 1, middle = sheet.rows() / 2;
  // Over a few rows in the middle, where an edge layer is long gone.
  constexpr std::size_t bulk_rows = 4;
  const double bulk = (level(middle + bulk_rows) - level(middle)) / static_cast<double>(bulk_rows);
  EdgeLayer layer{bulk / pitch, {}, relaxation.residual};
  for (std::size_t j = 0; j < rows; ++j)
    layer.deviations.push_back((level(top - j) - level(top - j - 1)) / bulk - 1.);
  return layer;
}

double edge_decay(double spacing, const lattice::Material &material, double stretch, double stretch_across)
{
  const lattice::TriangularLattice sheet(spacing, 10. * spacing, 10. * spacing, lattice::Orientation::rows_along_crack);
  const double pitch = std::sqrt(3.) / 2. * spacing;
  // Stiffness between rows one and two apart against moving them in the direction across.
  double adjacent = 0., second = 0.;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d R = sheet.bond_vector(kind);
      const Eigen::Vector2d bond(stretch * R.x(), stretch_across * R.y());
      const double length = sheet.rest_length(kind), lambda = bond.norm() / length;
      const double across = std::pow(bond.normalized().y(), 2);
      const double k =
        lattice::cross_section(*shell, sheet) / length *
        (lattice::stiffness(shell->law, lambda) * across + lattice::force(shell->law, lambda) / lambda * (1. - across));
      const long rows_apart = std::lround(R.y() / pitch);
      if (rows_apart == 1)
        adjacent += k;
      else if (rows_apart == 2)
        second += k;
    }
  if (second == 0.)
    return 0.;
  // second (r + 1)^2 + adjacent r = 0, the root inside the unit circle without cancellation.
  const double b = 2. + adjacent / second;
  return -2. / (b + std::sqrt(b * b - 4.));
}

} // namespace latcon::claims
