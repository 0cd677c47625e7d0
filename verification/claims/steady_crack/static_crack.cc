#include "verification/claims/steady_crack/steady_crack.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/SparseCholesky>

namespace latcon::claims
{
namespace
{

// Sites (row, column) at x = column + row/2: a sheared patch of the lattice, whose bonds have the same steps in every
// row. Rows 0 and 2 N + 1 are held.
class Patch
{
public:
  Patch(std::size_t free_rows, std::size_t columns) : free_rows_(free_rows), columns_(columns) {}

  struct Bond
  {
    std::size_t row, column, far_row, far_column;
    Eigen::Vector2d direction;
  };

  template <class Visitor>
  void for_each_bond(const Visitor &visit) const
  {
    const Eigen::Vector2d along(1., 0.), right(0.5, std::sqrt(3.) / 2.), left(-0.5, std::sqrt(3.) / 2.);
    for (std::size_t row = 0; row < rows(); ++row)
      for (std::size_t column = 0; column < columns_; ++column)
      {
        if (column + 1 < columns_)
          visit(Bond{row, column, row, column + 1, along});
        if (row + 1 < rows())
          visit(Bond{row, column, row + 1, column, right});
        if (row + 1 < rows() && column > 0)
          visit(Bond{row, column, row + 1, column - 1, left});
      }
  }

  std::size_t rows() const { return 2 * free_rows_ + 2; }
  bool is_held(std::size_t row) const { return row == 0 || row == rows() - 1; }
  bool crosses_crack(const Bond &bond) const { return bond.row == free_rows_ && bond.far_row == free_rows_ + 1; }
  /// First of the two unknowns of a free site.
  Eigen::Index unknown(std::size_t row, std::size_t column) const
  {
    return static_cast<Eigen::Index>(2 * ((row - 1) * columns_ + column));
  }
  Eigen::Index n_unknowns() const { return static_cast<Eigen::Index>(4 * free_rows_ * columns_); }

private:
  std::size_t free_rows_, columns_;
};

// Position of a bond along the crack, in halves of a spacing: the order in which the bonds across it break.
std::size_t halves(const Patch::Bond &bond)
{
  return bond.column + bond.far_column;
}

} // namespace

TrappingWindow trapping_window(const CrackStrip &strip, std::size_t columns)
{
  const Patch patch(strip.free_rows, columns);
  const std::size_t first_whole = columns;                // halves(): the middle of the row
  const double top = static_cast<double>(strip.layers()); // u_y of the upper row; the lower one rests

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(patch.n_unknowns());
  patch.for_each_bond(
    [&](const Patch::Bond &bond)
    {
      if (patch.crosses_crack(bond) && halves(bond) < first_whole)
        return;
      const Eigen::Matrix2d stiffness = bond.direction * bond.direction.transpose();
      const auto add =
        [&](std::size_t row, std::size_t column, std::size_t other_row, std::size_t other_column, int sign)
      {
        if (patch.is_held(row))
          return;
        const Eigen::Index i = patch.unknown(row, column);
        if (!patch.is_held(other_row))
          for (Eigen::Index a = 0; a < 2; ++a)
            for (Eigen::Index b = 0; b < 2; ++b)
              entries.emplace_back(i + a, patch.unknown(other_row, other_column) + b, sign * stiffness(a, b));
        else if (other_row != 0)
          load.segment<2>(i) -= sign * stiffness.col(1) * top;
      };
      add(bond.row, bond.column, bond.row, bond.column, 1);
      add(bond.far_row, bond.far_column, bond.far_row, bond.far_column, 1);
      add(bond.row, bond.column, bond.far_row, bond.far_column, -1);
      add(bond.far_row, bond.far_column, bond.row, bond.column, -1);
    });
  Eigen::SparseMatrix<double> matrix(patch.n_unknowns(), patch.n_unknowns());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("the strip with a crack at rest has no equilibrium");
  const Eigen::VectorXd u = solver.solve(load);

  double next = 0., last = 0.;
  patch.for_each_bond(
    [&](const Patch::Bond &bond)
    {
      if (!patch.crosses_crack(bond) || halves(bond) > first_whole || halves(bond) + 1 < first_whole)
        return;
      const Eigen::Vector2d opening =
        u.segment<2>(patch.unknown(bond.far_row, bond.far_column)) - u.segment<2>(patch.unknown(bond.row, bond.column));
      (halves(bond) == first_whole ? next : last) = bond.direction.dot(opening);
    });
  // Bonds of the strip ahead are elongated by sin 60 degrees for each unit of height; at Griffith's threshold by
  // 1 / sqrt(layers) of the breaking elongation.
  const double ahead = std::sqrt(3.) / 2. * top / static_cast<double>(strip.layers());
  const double threshold = 1. / std::sqrt(static_cast<double>(strip.layers()));
  return {ahead / last / threshold, ahead / next / threshold};
}

} // namespace latcon::claims
