#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace latcon::lattice
{

/// Direction of the rows of nearest neighbours. The crack runs along x.
enum class Orientation
{
  rows_along_crack, ///< NN bonds at 0, 60, 120 degrees to x, NNN bonds at 30, 90, 150
  rows_across_crack ///< turned by 30 degrees: NN bonds at 30, 90, 150, NNN bonds at 0, 60, 120
};

/// Shells of bonds, by increasing rest length: nearest neighbours (d), next-nearest (sqrt3 d) and third-nearest (2 d,
/// in the directions of the nearest). A material need not have all of them.
inline constexpr std::size_t n_shells = 3;
/// Names of the shells in files and messages.
inline constexpr std::array<const char *, n_shells> shell_names{{"nearest", "next-nearest", "third-nearest"}};

/// Distance of two rows of a triangular grid over its spacing.
inline const double half_sqrt3 = std::sqrt(3.) / 2.;

/// Random displacements of the points of a grid, independent of each other and of the number of points.
struct Scatter
{
  double amplitude = 0.;  ///< largest displacement along x and along y, over the spacing [-], 0 to 0.5; 0: none
  std::uint64_t seed = 0; ///< of the displacements, which are uniform in the square

  /// Displacement of a point over the spacing [-]. @param row,column negative ones modulo 2^64
  Eigen::Vector2d displacement(std::size_t row, std::size_t column) const;
};

/// A grid of reference points without end, at column * a1 + row * a2 before they are scattered.
struct Grid
{
  enum class Kind
  {
    triangular, ///< a1 = h (1, 0), a2 = h (1, sqrt3) / 2 with rows along the crack
    square      ///< a1 = h (1, 0), a2 = h (0, 1) likewise
  };

  Kind kind;
  double spacing; ///< h [m], > 0
  /// Direction of its rows; x and y are exchanged where they are across the crack.
  Orientation orientation = Orientation::rows_along_crack;
  Scatter scatter = {}; ///< of the points; none by default

  /// Vector of a number of spacings along the rows and of rows across them [m].
  Eigen::Vector2d from_row_frame(double along, double across) const;

  /// Reference vector from a point to the one at a distance of these columns and rows [m].
  Eigen::Vector2d vector(int columns, int rows) const
  {
    return from_row_frame(columns + (kind == Kind::triangular ? 0.5 * rows : 0.), rows);
  }
  double pitch() const { return kind == Kind::triangular ? half_sqrt3 : 1.; } ///< distance of rows, in spacings
};

/// A bond of a stencil, seen from one of its ends.
struct HalfBond
{
  int columns, rows;      ///< of the grid, from the near to the far end; rows > 0, or rows = 0 and columns > 0
  Eigen::Vector2d vector; ///< R, reference vector from the near to the far end [m]
  double rest_length;     ///< |R| [m]
  double weight;          ///< q [-], > 0: share of the bond in the energy of its shell
  std::size_t shell;      ///< whose law it has; that of its ring
  double radius;          ///< l of its ring [m]
};

/// Bonds of one length that leave every point of a nonlocal continuum.
struct Ring
{
  double radius;                 ///< l [m], > 0
  double direction;              ///< angle of one of its six middle directions to x [rad]
  std::size_t shell;             ///< whose law the bonds have; below n_shells
  double half_width = M_PI / 6.; ///< of the arcs about these directions [rad], 0 (six directions) to pi/6 (all)
};

/// Half-bonds of the triangular lattice on its grid: three for each shell, third-nearest ones included.
std::vector<HalfBond> triangular_stencil(const Grid &grid);

/// The rings that shells of the triangular lattice with spacing d [m] sample: of nearest and next-nearest neighbours.
std::vector<Ring> lattice_rings(double d, Orientation orientation, double half_width);

/// Half-bonds of rings on a grid. Those of scattered points are of all the pairs that a ring can join, in all
/// directions; a sheet's construction gives them their weights, see ScatteredBonds.
///
/// A bond belongs to a ring if its length is nearer than h to the radius l and its direction in one of the arcs. Its
/// weight falls linearly to 0 with that distance. A relative correction, the smallest in the mean square, then gives
/// the weights of each ring the fourth moments of all directions, isotropic ones: the sums of q, q n_x^4, q n_y^4 and
/// q n_x^2 n_y^2 are 1, 3/8, 3/8 and 1/8, those of q n_x^3 n_y and q n_x n_y^3 are 0. So energies near F = I are those
/// of the isotropic network to round-off. Farther away their error falls only as the square root of h / l, since the
/// ring becomes as thin as the grid is fine; it is below 1e-3 from l = 2 h on. That of the dispersion of waves falls as
/// h / l.
///
/// @throws std::invalid_argument if the grid has too few bonds in the arcs for these moments, if one of the weights is
/// not positive, or if the bonds leave the grid in parts that do not know each other
///
/// On a triangular grid of the lattice's spacing, six directions give the first half-bonds of triangular_stencil(), bit
/// for bit.
std::vector<HalfBond> ring_stencil(const Grid &grid, const std::vector<Ring> &rings);

} // namespace latcon::lattice
