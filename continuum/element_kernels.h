#pragma once

// What an element sums over its nodes at one point. `basis` holds, row by row at a distance of `stride`, a multiple of
// four, the derivatives of the shape functions: row s * n_derivatives + c is derivative c on side s. All rows are
// padded with zeros.

#include "continuum/point_integrand.h"

namespace latcon::continuum
{
/// Rows of the basis that a density looks at: of each of `n_sides` sides the first `n_derivatives`.
struct Rows
{
  unsigned int n_sides;
  unsigned int n_derivatives;
};

/// derivatives[i][row] = sum over nodes of basis[row][a] u[i][a], for both components i.
void evaluate_derivatives(const double *basis, unsigned int stride, const Rows &rows, const double *u,
                          double *derivatives);

/// r[a] += weight * sum over rows of first[row] basis[row][a], and magnitude[a] the absolute values of the same terms.
void add_first(const double *basis, unsigned int stride, const Rows &rows, const double *first, double weight,
               double *r, double *magnitude);

/// K[a][b] += weight * sum of basis[row][a] second[row][column] basis[column][b], where `second` is a square of
/// 2 * n_derivatives rows. Of a matrix that `is_symmetric`, entries below the diagonal are left undefined. `work` has
/// room for 2 * n_derivatives * stride numbers.
void add_second(const double *basis, unsigned int stride, const Rows &rows, const double *second, double weight,
                bool is_symmetric, unsigned int n_nodes, double *work, double *K);
} // namespace latcon::continuum
