#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "lattice/triangular_lattice.h"

namespace latcon::lattice
{

/// A grid of reference points without end, at column * a1 + row * a2.
struct Grid
{
  enum class Kind
  {
    triangular, ///< a1 = h (1, 0), a2 = h (1, sqrt3) / 2 before the rotation
    square      ///< a1 = h (1, 0), a2 = h (0, 1) before the rotation
  };

  Kind kind;
  double spacing;       ///< h [m], > 0
  double rotation = 0.; ///< of the whole grid, counter-clockwise [rad]

  /// Reference vector from a point to the one that is so many columns and rows away [m].
  Eigen::Vector2d vector(int columns, int rows) const;
  /// Reference area of a point [m^2].
  double cell_area() const;
};

/// A bond of a stencil, seen from one of its ends.
struct HalfBond
{
  int columns, rows;      ///< of the grid, from the near to the far end; rows > 0, or rows = 0 and columns > 0
  Eigen::Vector2d vector; ///< R, reference vector from the near to the far end [m]
  double rest_length;     ///< |R| [m]
  double weight;          ///< q [-], > 0: share of the bond in the energy of its shell
  std::size_t shell;      ///< whose law it has; that of its ring
};

/// Bonds of one length that leave every point of a nonlocal continuum.
struct Ring
{
  double radius;                 ///< l [m], > 0
  double direction;              ///< angle of one of its six middle directions to x [rad]
  std::size_t shell;             ///< whose law the bonds have; below n_shells
  double half_width = M_PI / 6.; ///< of the arcs about these directions [rad], 0 (six directions) to pi/6 (all)
};

/// The rings that shells of the triangular lattice with spacing d [m] sample: of nearest and next-nearest neighbours.
std::vector<Ring> lattice_rings(double d, Orientation orientation, double half_width);

/// Half-bonds of rings on a grid.
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
std::vector<HalfBond> ring_stencil(const Grid &grid, const std::vector<Ring> &rings);

} // namespace latcon::lattice
