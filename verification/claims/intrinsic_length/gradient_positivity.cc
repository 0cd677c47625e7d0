#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

#include <cmath>
#include <limits>

#include "support/dense.h"
#include "verification/bridge/homogenisation.h"

namespace latcon::claims
{
namespace
{

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Gradients G_iJK as vectors of length |G|: for i = x and y the entries xx, yy and, counted twice, xy.
struct Unit
{
  unsigned int i;
  Eigen::Matrix2d entries; // in J, K
};

std::array<Unit, 6> units()
{
  std::array<Unit, 6> result;
  for (unsigned int i = 0; i < 2; ++i)
  {
    Eigen::Matrix2d xx = Eigen::Matrix2d::Zero(), yy = xx, xy = xx;
    xx(0, 0) = yy(1, 1) = 1.;
    xy(0, 1) = xy(1, 0) = std::sqrt(0.5);
    result[3 * i] = {i, xx};
    result[3 * i + 1] = {i, yy};
    result[3 * i + 2] = {i, xy};
  }
  return result;
}

// W_g = (l_d^2 positive - negative)(G, G) / 2, in Pa and Pa m^2.
struct Parts
{
  Matrix6 positive = Matrix6::Zero();
  Matrix6 negative = Matrix6::Zero();
};

Parts lattice_parts(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                    const Eigen::Matrix2d &F)
{
  Parts parts;
  const auto basis = units();
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    const lattice::Shell *shell = material.shell(kind);
    if (shell == nullptr)
      continue;
    const double length = lattice.rest_length(kind);
    const Eigen::Vector2d N = lattice.bond_vector(kind) / length;
    const double weight = lattice::cross_section(*shell, lattice) * length / lattice.site_area();
    const double stretch = (F * N).norm();
    const Eigen::Vector2d n = (F * N).normalized();
    const Eigen::Matrix2d h =
      lattice::stiffness(shell->law, stretch) * n * n.transpose() +
      lattice::force(shell->law, stretch) / stretch * (Eigen::Matrix2d::Identity() - n * n.transpose());
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
      {
        const Unit &A = basis[static_cast<std::size_t>(a)], &B = basis[static_cast<std::size_t>(b)];
        const Eigen::Vector2d GA = A.entries * N, GB = B.entries * N; // by the free index J
        parts.positive(a, b) += weight * h(A.i, B.i) * GA.dot(GB);
        parts.negative(a, b) += weight * length * length / 12. * h(A.i, B.i) * N.dot(GA) * N.dot(GB);
      }
  }
  return parts;
}

// Not-a-number if the matrix is not finite: the solver may return anything then.
double smallest(const Matrix6 &matrix)
{
  if (!matrix.allFinite())
    return std::numeric_limits<double>::quiet_NaN();
  return support::symmetric_eigenvalues(matrix)[0];
}

} // namespace

double smallest_eigenvalue(const continuum::GradientLaw &law, const Eigen::Matrix2d &F)
{
  const auto C = law.double_stress_by_G(bridge::to_continuum(F));
  const auto basis = units();
  Matrix6 matrix = Matrix6::Zero();
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
    {
      const Unit &A = basis[static_cast<std::size_t>(a)], &B = basis[static_cast<std::size_t>(b)];
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          for (unsigned int M = 0; M < 2; ++M)
            for (unsigned int N = 0; N < 2; ++N)
              matrix(a, b) += A.entries(J, K) * C[A.i][J][K][B.i][M][N] * B.entries(M, N);
    }
  return smallest(matrix);
}

double smallest_lattice_eigenvalue(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                   const Eigen::Matrix2d &F, double length)
{
  const Parts parts = lattice_parts(lattice, material, F);
  return smallest(length * length * parts.positive - parts.negative);
}

std::optional<double> critical_length(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                      const Eigen::Matrix2d &F)
{
  const Parts parts = lattice_parts(lattice, material, F);
  if (!parts.positive.allFinite() || !parts.negative.allFinite())
    return std::numeric_limits<double>::quiet_NaN();
  const support::SymmetricModes positive = support::symmetric_modes(parts.positive);
  // A gradient that no bond feels counts for neither part. One that makes the positive part negative leaves no length.
  const double round_off = 1e-12 * positive.values[5];
  if (positive.values[0] < -round_off)
    return {};
  Matrix6 scaled = Matrix6::Zero(); // positive^(-1/2), on its range
  for (int i = 0; i < 6; ++i)
    if (positive.values[i] > round_off)
      scaled += positive.vectors.col(i) * positive.vectors.col(i).transpose() / std::sqrt(positive.values[i]);
  return std::sqrt(support::symmetric_eigenvalues(scaled * parts.negative * scaled)[5]);
}

} // namespace latcon::claims
