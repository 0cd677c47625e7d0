#include "lattice/stencil.h"

#include <cstdlib>
#include <numeric>

#include "lattice/disorder.h"
#include "support/dense.h"
#include "support/require.h"

namespace latcon::lattice
{
namespace
{

constexpr double round_off = 1e-9; // of lengths over h, and of angles

// Half-bonds of a ring whose lengths are nearer than `width` spacings to its radius, with weights that are not yet
// corrected.
std::vector<HalfBond> half_bonds(const Grid &grid, const Ring &ring, double width)
{
  std::vector<HalfBond> found;
  const double h = grid.spacing;
  // Rows of a triangular grid are sqrt3 / 2 apart, and columns lean by half a row.
  const int rows = static_cast<int>(std::ceil(1.2 * (ring.radius / h + width))), columns = 2 * rows;
  for (int row = 0; row <= rows; ++row)
    for (int column = columns; column >= (row == 0 ? 1 : -columns); --column)
    {
      const Eigen::Vector2d R = grid.vector(column, row);
      // Bonds that are those of a lattice have its lengths to the last bit.
      const bool is_exact = std::abs(R.norm() - ring.radius) < round_off * h;
      const double length = is_exact ? ring.radius : R.norm();
      const double weight = width - std::abs(length - ring.radius) / h;
      const double off = std::remainder(std::atan2(R.y(), R.x()) - ring.direction, M_PI / 3.);
      if (weight > round_off && std::abs(off) <= ring.half_width + round_off)
        found.push_back({column, row, R, length, weight, ring.shell, ring.radius});
    }
  return found;
}

// Corrects weights q to q (1 + z / sqrt q), with the smallest sum of z^2 that gives harmonics of directions their means
// over all directions: 1, 0, 0, 0, 0, which is the same as the fourth moments of all directions.
void correct(std::vector<HalfBond> &bonds)
{
  Eigen::VectorXd root(bonds.size());
  Eigen::MatrixXd scaled(5, bonds.size());
  double sum = 0.;
  for (const HalfBond &bond : bonds)
    sum += bond.weight;
  for (std::size_t i = 0; i < bonds.size(); ++i)
  {
    bonds[i].weight /= sum;
    root[i] = std::sqrt(bonds[i].weight);
    const double angle = std::atan2(bonds[i].vector.y(), bonds[i].vector.x());
    scaled.col(i) << 1., std::cos(2. * angle), std::sin(2. * angle), std::cos(4. * angle), std::sin(4. * angle);
    scaled.col(i) *= root[i];
  }
  const Eigen::VectorXd missing = Eigen::VectorXd::Unit(5, 0) - scaled * root;
  if (missing.norm() < 1e-14) // three directions have these moments
    return;
  const Eigen::VectorXd z = support::shortest_least_squares(scaled, missing);
  support::require(
    (scaled * z - missing).norm() < 1e-12 && (root + z).minCoeff() > 0.,
    "a ring has too few bonds in its arcs for isotropic fourth moments with positive weights: a finer grid or "
    "wider arcs are needed");
  for (std::size_t i = 0; i < bonds.size(); ++i)
    bonds[i].weight = root[i] * (root[i] + z[i]);
}

} // namespace

Eigen::Vector2d Grid::from_row_frame(double along, double across) const
{
  const double u = along * spacing, v = across * pitch() * spacing;
  return orientation == Orientation::rows_along_crack ? Eigen::Vector2d(u, v) : Eigen::Vector2d(v, u);
}

Eigen::Vector2d Scatter::displacement(std::size_t row, std::size_t column) const
{
  const std::uint64_t point = row << 32u | static_cast<std::uint32_t>(column),
                      key = splitmix64(splitmix64(splitmix64(seed) + 3) + point);
  return amplitude * Eigen::Vector2d(symmetric_uniform(splitmix64(key)), symmetric_uniform(splitmix64(key + 1)));
}

std::vector<HalfBond> triangular_stencil(const Grid &grid)
{
  constexpr int offsets[3 * n_shells][2] = {{1, 0}, {0, 1}, {-1, 1}, {1, 1}, {-2, 1}, {-1, 2}, {2, 0}, {0, 2}, {-2, 2}};
  const std::array<double, n_shells> lengths{{1., 2. * half_sqrt3, 2.}};
  std::vector<HalfBond> stencil;
  for (const auto &[columns, rows] : offsets)
  {
    const std::size_t shell = stencil.size() / 3;
    const double length = lengths[shell] * grid.spacing;
    stencil.push_back({columns, rows, grid.vector(columns, rows), length, 1. / 3., shell, length});
  }
  return stencil;
}

std::vector<Ring> lattice_rings(double d, Orientation orientation, double half_width)
{
  const double turned = M_PI / 6., nearest = orientation == Orientation::rows_along_crack ? 0. : turned;
  return {{d, nearest, 0, half_width}, {std::sqrt(3.) * d, turned - nearest, 1, half_width}};
}

std::vector<HalfBond> ring_stencil(const Grid &grid, const std::vector<Ring> &rings)
{
  const double scatter = grid.scatter.amplitude;
  support::require(grid.spacing > 0. && std::isfinite(grid.spacing), "the spacing of a grid must be positive");
  std::vector<HalfBond> stencil;
  for (const Ring &ring : rings)
  {
    support::require(ring.radius > 0. && std::isfinite(ring.radius) && ring.shell < n_shells,
                     "a ring needs a positive radius and a shell");
    support::require(ring.half_width >= 0. && ring.half_width <= M_PI / 6. + round_off,
                     "the half-width of the arcs of a ring must be between 0 and 30 degrees");
    const Ring all_directions{ring.radius, ring.direction, ring.shell};
    std::vector<HalfBond> bonds = half_bonds(grid, scatter > 0. ? all_directions : ring, 1. + std::sqrt(8.) * scatter);
    support::require(!bonds.empty(), "a ring has no bonds in its arcs: a finer grid or wider arcs are needed");
    if (scatter == 0.)
      correct(bonds);
    stencil.insert(stencil.end(), bonds.begin(), bonds.end());
  }
  // Sums of offsets reach all points if the areas that two of them span have that of a cell as largest common divisor.
  int divisor = 0;
  for (const HalfBond &a : stencil)
    for (const HalfBond &b : stencil)
      divisor = std::gcd(divisor, a.columns * b.rows - b.columns * a.rows);
  support::require(divisor == 1, "the bonds join not all points of the grid: wider arcs are needed");
  return stencil;
}

} // namespace latcon::lattice
