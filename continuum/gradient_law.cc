#include "continuum/gradient_law.h"

#include "support/largest_error.h"

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
double GradientLaw::normal_stiffness() const
{
  const Tensor<2, 2> I(dealii::unit_symmetric_tensor<2>());
  const Tensor<6, 2> C = double_stress_by_G(I);
  // The matrix entries are trigonometric polynomials of degree 4 or less in the angle: steps of one degree are
  // practically exact.
  constexpr unsigned int n_angles = 180;
  double largest = 0.;
  for (unsigned int sample = 0; sample < n_angles; ++sample)
  {
    const double angle = std::acos(-1.) * sample / n_angles;
    const Tensor<1, 2> n({std::cos(angle), std::sin(angle)});
    Tensor<2, 2> A;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int l = 0; l < 2; ++l)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
            for (unsigned int M = 0; M < 2; ++M)
              for (unsigned int N = 0; N < 2; ++N)
                A[i][l] += C[i][J][K][l][M][N] * n[J] * n[K] * n[M] * n[N];
    largest = support::largest_of(
      {largest, 0.5 * (A[0][0] + A[1][1]) + std::hypot(0.5 * (A[0][0] - A[1][1]), A[0][1])}); // keeps what is no number
  }
  return largest;
}
} // namespace latcon::continuum
