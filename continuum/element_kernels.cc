#include "continuum/element_kernels.h"

#include "continuum/vector_kernels.h"

namespace latcon::continuum
{
namespace
{
constexpr unsigned int n_rows = 2 * n_derivatives;
}

LATCON_CLONES void evaluate_derivatives(const double *basis, const unsigned int stride, const Rows &rows,
                                        const double *u, double *derivatives)
{
  for (unsigned int s = 0; s < rows.n_sides; ++s)
    for (unsigned int c = 0; c < rows.n_derivatives; ++c)
    {
      const unsigned int row = s * n_derivatives + c;
      Lanes sums[2] = {};
      for (unsigned int a = 0; a < stride; a += n_lanes)
      {
        Lanes shape;
        std::memcpy(&shape, basis + row * stride + a, sizeof(shape));
        for (unsigned int i = 0; i < 2; ++i)
        {
          Lanes nodal;
          std::memcpy(&nodal, u + i * stride + a, sizeof(nodal));
          sums[i] += shape * nodal;
        }
      }
      for (unsigned int i = 0; i < 2; ++i)
        derivatives[i * n_rows + row] = (sums[i][0] + sums[i][1]) + (sums[i][2] + sums[i][3]);
    }
}

LATCON_CLONES void add_first(const double *basis, const unsigned int stride, const Rows &rows, const double *first,
                             const double weight, double *r, double *magnitude)
{
  for (unsigned int a = 0; a < stride; a += n_lanes)
  {
    Lanes sum;
    Lanes absolute;
    std::memcpy(&sum, r + a, sizeof(sum));
    std::memcpy(&absolute, magnitude + a, sizeof(absolute));
    for (unsigned int s = 0; s < rows.n_sides; ++s)
      for (unsigned int c = 0; c < rows.n_derivatives; ++c)
      {
        Lanes shape;
        std::memcpy(&shape, basis + (s * n_derivatives + c) * stride + a, sizeof(shape));
        const Lanes term = weight * first[s * n_derivatives + c] * shape;
        sum += term;
        absolute += term < 0. ? -term : term;
      }
    std::memcpy(r + a, &sum, sizeof(sum));
    std::memcpy(magnitude + a, &absolute, sizeof(absolute));
  }
}

LATCON_CLONES void add_second(const double *basis, const unsigned int stride, const Rows &rows, const double *second,
                              const double weight, const bool is_symmetric, const unsigned int n_nodes, double *work,
                              double *K)
{
  // Products of `second` and basis, without the zeros of `second`, of which laws have many.
  unsigned int n_products = 0;
  unsigned int row_of[n_rows]; // of each product
  for (unsigned int s = 0; s < rows.n_sides; ++s)
    for (unsigned int c = 0; c < rows.n_derivatives; ++c)
    {
      const unsigned int row = s * n_derivatives + c;
      unsigned int n_factors = 0;
      double factors[n_rows];
      unsigned int columns[n_rows];
      for (unsigned int t = 0; t < rows.n_sides; ++t)
        for (unsigned int e = 0; e < rows.n_derivatives; ++e)
          if (const double entry = second[row * n_rows + t * n_derivatives + e]; entry != 0.)
          {
            factors[n_factors] = weight * entry;
            columns[n_factors++] = t * n_derivatives + e;
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
          std::memcpy(&shape, basis + columns[k] * stride + a, sizeof(shape));
          sum += factors[k] * shape;
        }
        std::memcpy(product + a, &sum, sizeof(sum));
      }
    }
  if (n_products == 0)
    return;
  for (unsigned int a = 0; a < n_nodes; ++a)
  {
    double shapes[n_rows];
    for (unsigned int k = 0; k < n_products; ++k)
      shapes[k] = basis[row_of[k] * stride + a];
    for (unsigned int b = is_symmetric ? a / n_lanes * n_lanes : 0; b < stride; b += n_lanes)
    {
      Lanes sum;
      std::memcpy(&sum, K + a * stride + b, sizeof(sum));
      for (unsigned int k = 0; k < n_products; ++k)
      {
        Lanes product;
        std::memcpy(&product, work + k * stride + b, sizeof(product));
        sum += shapes[k] * product;
      }
      std::memcpy(K + a * stride + b, &sum, sizeof(sum));
    }
  }
}
} // namespace latcon::continuum
