#pragma once

// Sums over the nodes of an element at one point. A `basis` contains derivatives of the shape functions by rows, of
// which the densities depend on the first `n_rows`. `stride` is the length of a row, a multiple of four; all rows are
// padded with zeros.

#include "continuum/point_integrand.h"

namespace latcon::continuum
{
/// Computes derivatives[i][row] = sum over nodes of basis[i][row][a] u[i][a] for both components i.
void evaluate_derivatives(const std::array<const double *, 2> &basis, unsigned int stride, unsigned int n_rows,
                          const double *u, FieldDerivatives &derivatives);

/// Adds weight * sum over rows of first[row] basis[row][a] to r[a], and the absolute values of the same terms to
/// magnitude[a].
void add_first(const double *basis, unsigned int stride, unsigned int n_rows, const double *first, double weight,
               double *r, double *magnitude);

/// Adds weight * sum over rows and columns of basis[row][a] second[row][column] columns[column][b] to K[a][b], where
/// `second` is square with n_derivatives rows, K with `stride` rows, and `basis` and `columns` belong to either
/// component. If `is_symmetric`, entries of K below the diagonal are undefined. `work` is scratch space for
/// n_derivatives * stride numbers.
void add_second(const double *basis, const double *columns, unsigned int stride, unsigned int n_rows,
                const double *second, double weight, bool is_symmetric, double *work, double *K);
} // namespace latcon::continuum
