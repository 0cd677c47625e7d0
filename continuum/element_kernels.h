#pragma once

// Sums over the nodes of an element at one point. `basis` contains the derivatives of the shape functions by rows: row
// s * n_derivatives + c is derivative c on side s. `stride` is the length of a row, a multiple of four; all rows are
// padded with zeros.

#include "continuum/point_integrand.h"

namespace latcon::continuum
{
/// Rows of the basis on which a density depends: the first `n_derivatives` on each of `n_sides` sides.
struct Rows
{
  unsigned int n_sides;
  unsigned int n_derivatives;
};

/// Computes derivatives[i][row] = sum over nodes of basis[row][a] u[i][a], for both components i.
void evaluate_derivatives(const double *basis, unsigned int stride, const Rows &rows, const double *u,
                          double *derivatives);

/// Adds weight * sum over rows of first[row] basis[row][a] to r[a], and the absolute values of the same terms to
/// magnitude[a].
void add_first(const double *basis, unsigned int stride, const Rows &rows, const double *first, double weight,
               double *r, double *magnitude);

/// Adds weight * sum over rows and columns of basis[row][a] second[row][column] basis[column][b] to K[a][b], where
/// `second` is square with 2 * n_derivatives rows. If `is_symmetric`, entries of K below the diagonal are undefined.
/// `work` is scratch space for 2 * n_derivatives * stride numbers.
void add_second(const double *basis, unsigned int stride, const Rows &rows, const double *second, double weight,
                bool is_symmetric, unsigned int n_nodes, double *work, double *K);
} // namespace latcon::continuum
