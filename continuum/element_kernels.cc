#include "continuum/element_kernels.h"

#include "continuum/vector_kernels.h"

namespace latcon::continuum
{
LATCON_CLONES void evaluate_derivatives(const std::array<const double *, 2> &basis, const unsigned int stride,
                                        const unsigned int n_rows, const double *u, FieldDerivatives &derivatives)
{
  for (unsigned int row = 0; row < n_rows; ++row)
    for (unsigned int i = 0; i < 2; ++i)
    {
      Lanes sum = {};
      for (unsigned int a = 0; a < stride; a += n_lanes)
      {
        Lanes shape;
        Lanes nodal;
        std::memcpy(&shape, basis[i] + row * stride + a, sizeof(shape));
        std::memcpy(&nodal, u + i * stride + a, sizeof(nodal));
        sum += shape * nodal;
      }
      derivatives[i][row] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
}

LATCON_CLONES void add_first(const double *basis, const unsigned int stride, const unsigned int n_rows,
                             const double *first, const double weight, double *r, double *magnitude)
{
  for (unsigned int a = 0; a < stride; a += n_lanes)
  {
    Lanes sum;
    Lanes absolute;
    std::memcpy(&sum, r + a, sizeof(sum));
    std::memcpy(&absolute, magnitude + a, sizeof(absolute));
    for (unsigned int row = 0; row < n_rows; ++row)
    {
      Lanes shape;
      std::memcpy(&shape, basis + row * stride + a, sizeof(shape));
      const Lanes term = weight * first[row] * shape;
      sum += term;
      absolute += term < 0. ? -term : term;
    }
    std::memcpy(r + a, &sum, sizeof(sum));
    std::memcpy(magnitude + a, &absolute, sizeof(absolute));
  }
}

LATCON_CLONES void add_second(const double *basis, const double *columns, const unsigned int stride,
                              const unsigned int n_rows, const double *second, const double weight,
                              const bool is_symmetric, double *work, double *K)
{
  // Products of `second` and columns, without the zeros of `second`, of which laws have many.
  unsigned int n_products = 0;
  unsigned int row_of[n_derivatives]; // of each product
  for (unsigned int row = 0; row < n_rows; ++row)
  {
    unsigned int n_factors = 0;
    double factors[n_derivatives];
    unsigned int column_of[n_derivatives];
    for (unsigned int column = 0; column < n_rows; ++column)
      if (const double entry = second[row * n_derivatives + column]; entry != 0.)
      {
        factors[n_factors] = weight * entry;
        column_of[n_factors++] = column;
      }
    if (n_factors == 0)
      continue;
    row_of[n_products] = row;
    double *product = work + n_products++ * stride;
    for (unsigned int a = 0; a < stride; a += n_lanes)
    {
      Lanes sum = {};
      for (unsigned int k = 0; k < n_factors; ++k)
      {
        Lanes shape;
        std::memcpy(&shape, columns + column_of[k] * stride + a, sizeof(shape));
        sum += factors[k] * shape;
      }
      std::memcpy(product + a, &sum, sizeof(sum));
    }
  }
  if (n_products == 0)
    return;
  // Four rows of K at a time, which share the products. Sums in an array would not stay in registers.
  for (unsigned int a = 0; a < stride; a += n_lanes)
  {
    double shapes[n_derivatives][n_lanes];
    for (unsigned int k = 0; k < n_products; ++k)
      std::memcpy(shapes[k], basis + row_of[k] * stride + a, sizeof(shapes[k]));
    for (unsigned int b = is_symmetric ? a : 0; b < stride; b += n_lanes)
    {
      double *rows = K + a * stride + b;
      Lanes s0, s1, s2, s3;
      std::memcpy(&s0, rows, sizeof(s0));
      std::memcpy(&s1, rows + stride, sizeof(s1));
      std::memcpy(&s2, rows + 2 * stride, sizeof(s2));
      std::memcpy(&s3, rows + 3 * stride, sizeof(s3));
      for (unsigned int k = 0; k < n_products; ++k)
      {
        Lanes product;
        std::memcpy(&product, work + k * stride + b, sizeof(product));
        s0 += shapes[k][0] * product;
        s1 += shapes[k][1] * product;
        s2 += shapes[k][2] * product;
        s3 += shapes[k][3] * product;
      }
      std::memcpy(rows, &s0, sizeof(s0));
      std::memcpy(rows + stride, &s1, sizeof(s1));
      std::memcpy(rows + 2 * stride, &s2, sizeof(s2));
      std::memcpy(rows + 3 * stride, &s3, sizeof(s3));
    }
  }
}
} // namespace latcon::continuum
