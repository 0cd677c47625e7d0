#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "lattice/relaxation.h"
#include "support/dense.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/plane_waves.h"

namespace latcon::claims
{
namespace
{

// Coefficient of k^2 by which waves of stiffness A2 k^2 - A4 k^4 soften, for both waves [unit of A4 over that of A2].
Alpha softening(const Eigen::Matrix2d &A2, const Eigen::Matrix2d &A4, const Eigen::Vector2d &normal)
{
  Alpha alpha{};
  const std::array<bridge::PlaneWave, 2> long_waves = bridge::plane_waves({A2, Eigen::Matrix2d::Zero()}, normal);
  for (std::size_t w = 0; w < 2; ++w)
  {
    const Eigen::Vector2d &p = long_waves[w].polarisation;
    alpha[w] = p.dot(A4 * p) / p.dot(A2 * p);
  }
  return alpha;
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Gradients G_iJK as vectors of length |G|: for i = x and y the entries xx, yy and, counted twice, xy.
struct Unit
{
  unsigned int i;
  Eigen::Matrix2d entries; // in J, K
};

// Matrix of a form of two such gradients.
template <class Form>
Matrix6 matrix_of(const Form &form)
{
  Eigen::Matrix2d xx = Eigen::Matrix2d::Zero(), yy = xx, xy = xx;
  xx(0, 0) = yy(1, 1) = 1.;
  xy(0, 1) = xy(1, 0) = std::sqrt(0.5);
  const Unit units[] = {{0, xx}, {0, yy}, {0, xy}, {1, xx}, {1, yy}, {1, xy}};
  Matrix6 matrix;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
      matrix(a, b) = form(units[a], units[b]);
  return matrix;
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
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    const lattice::Shell *shell = material.shell(kind);
    if (shell == nullptr)
      continue;
    const double length = lattice.rest_length(kind);
    const Eigen::Vector2d N = lattice.bond_vector(kind) / length;
    const double weight = bridge::bond_weight(lattice, *shell, kind);
    const Eigen::Matrix2d h = bridge::bond_tangent(shell->law, F * N);
    // With G N by the free index J.
    parts.positive += matrix_of([&](const Unit &A, const Unit &B)
                                { return weight * h(A.i, B.i) * (A.entries * N).dot(B.entries * N); });
    parts.negative +=
      matrix_of([&](const Unit &A, const Unit &B)
                { return weight * length * length / 12. * h(A.i, B.i) * N.dot(A.entries * N) * N.dot(B.entries * N); });
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

Alpha lattice_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                    const Eigen::Matrix2d &F, const Eigen::Vector2d &N, Alpha *nearest_part)
{
  // Stiffness against waves along N over the mass of a site, lengths over d: D = A2 k^2 - A4 k^4 + ... [1/s^2]
  Eigen::Matrix2d A2 = Eigen::Matrix2d::Zero(), A4 = A2, A4_of_nearest = A2;
  const double mass = lattice::site_mass(material, lattice);
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d R = lattice.bond_vector(kind);
      const double length = lattice.rest_length(kind), along = N.dot(R) / lattice.spacing();
      const Eigen::Matrix2d H =
        lattice::cross_section(*shell, lattice) / length / mass * bridge::bond_tangent(shell->law, F * R / length);
      A2 += std::pow(along, 2) * H;
      A4 += std::pow(along, 4) / 12. * H;
      if (lattice::shell_of(kind) == 0)
        A4_of_nearest += std::pow(along, 4) / 12. * H;
    }
  const Eigen::Vector2d normal = bridge::wave_normal(F, N);
  if (nearest_part != nullptr)
    *nearest_part = softening(A2, A4_of_nearest, normal);
  return softening(A2, A4, normal);
}

Alpha bloch_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Matrix2d &F, const Eigen::Vector2d &N)
{
  // With x = (kd)^2, w^2/x = c2 (1 - alpha x + beta x^2); three values give c2 and alpha, beta is in the way.
  const auto squares = [&](double kd) -> Eigen::Array2d
  {
    const auto waves = bridge::bloch_waves(lattice, material, F, kd / lattice.spacing() * N);
    return Eigen::Array2d(waves[0].frequency, waves[1].frequency).square() / (kd * kd);
  };
  constexpr double kd = 0.02;
  const Eigen::Array2d one = squares(kd), two = squares(2. * kd), four = squares(4. * kd);
  const double x = kd * kd;
  // Lagrange's interpolation at x, 4x, 16x: value and slope at 0.
  const Eigen::Array2d value = (64. * one - 20. * two + four) / 45.;
  const Eigen::Array2d slope = (-80. * one + 85. * two - 5. * four) / (180. * x);
  const Eigen::Array2d alpha = -slope / value;
  return {alpha[0], alpha[1]};
}

Alpha running_alpha(double spacing, lattice::Orientation orientation, const WaveDirection &direction,
                    const lattice::Material &material, const Eigen::Matrix2d &F)
{
  constexpr double lengths[] = {0.2, 0.4, 0.6, 0.8};
  Eigen::Matrix4d powers;
  Eigen::Matrix<double, 4, 2> squares;
  for (int i = 0; i < 4; ++i)
  {
    const WaveCell cell = wave_cell(spacing, orientation, direction, lengths[i]);
    const double x = std::pow(cell.K.norm() * spacing, 2);
    powers.row(i) << 1., x, x * x, x * x * x;
    const std::vector<Oscillation> waves = lattice_waves(cell, material, F);
    for (int w = 0; w < 2; ++w)
      squares(i, w) = std::pow(waves[static_cast<std::size_t>(w)].frequency, 2) / x;
  }
  const Eigen::Matrix<double, 4, 2> coefficients = powers.fullPivLu().solve(squares);
  return {-coefficients(1, 0) / coefficients(0, 0), -coefficients(1, 1) / coefficients(0, 1)};
}

Alpha continuum_alpha(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &N, double spacing)
{
  // (A2 k^2 + H k^4) / (1 + l_d^2 k^2): the matrices at two wave numbers are enough to tell A2 and H apart.
  const auto stiffness = [&](double kd)
  {
    const Eigen::Vector2d K = kd / spacing * N;
    const double inertia = 1. + std::pow(medium.inertia.length, 2) * K.squaredNorm();
    return Eigen::Matrix2d(continuum_matrices(medium, F, K).stiffness * inertia / (kd * kd));
  };
  const Eigen::Matrix2d one = stiffness(1.), two = stiffness(2.);
  const Eigen::Matrix2d H = (two - one) / 3., A2 = one - H;
  Alpha alpha = softening(A2, -H, bridge::wave_normal(F, N));
  for (double &of_wave : alpha)
    of_wave += std::pow(medium.inertia.length / spacing, 2);
  return alpha;
}

double smallest_eigenvalue(const continuum::GradientLaw &law, const Eigen::Matrix2d &F)
{
  const auto C = law.double_stress_by_G(bridge::to_continuum(F));
  return smallest(matrix_of(
    [&](const Unit &A, const Unit &B)
    {
      double sum = 0.;
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          for (unsigned int M = 0; M < 2; ++M)
            for (unsigned int N = 0; N < 2; ++N)
              sum += A.entries(J, K) * C[A.i][J][K][B.i][M][N] * B.entries(M, N);
      return sum;
    }));
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

EdgeLayer relaxed_edge(double spacing, const lattice::Material &material, double stretch, std::size_t rows)
{
  const double pitch = std::sqrt(3.) / 2. * spacing;
  const lattice::TriangularLattice sheet(spacing, 4. * spacing, 4. * static_cast<double>(rows) * pitch,
                                         lattice::Orientation::rows_along_crack, {true, false});
  Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  F(0, 0) = stretch;
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  // Forces are sums of up to eighteen of the order of section times modulus; 1e-13 of them is a deviation of as much.
  const double scale = lattice::cross_section(material.nearest, sheet) * lattice::stiffness(material.nearest.law, 1.);
  const double residual = lattice::relax(state, sheet, material, 1e-13 * scale);

  // The mean over a row: sites of one row stay level.
  const auto level = [&](std::size_t row)
  {
    double y = 0.;
    for (std::size_t column = 0; column < sheet.columns(); ++column)
      y += state.position.y[sheet.index(row, column)] / static_cast<double>(sheet.columns());
    return y;
  };
  const std::size_t top = sheet.rows() - 1, middle = sheet.rows() / 2;
  // Over a few rows in the middle, where an edge layer is long gone.
  constexpr std::size_t bulk_rows = 4;
  const double bulk = (level(middle + bulk_rows) - level(middle)) / static_cast<double>(bulk_rows);
  EdgeLayer layer{bulk / pitch, {}, residual};
  for (std::size_t j = 0; j < rows; ++j)
    layer.deviations.push_back((level(top - j) - level(top - j - 1)) / bulk - 1.);
  return layer;
}

double edge_decay(double spacing, const lattice::Material &material, double stretch, double stretch_across)
{
  const lattice::TriangularLattice sheet(spacing, 10. * spacing, 10. * spacing, lattice::Orientation::rows_along_crack);
  const double pitch = std::sqrt(3.) / 2. * spacing;
  // Stiffness between rows one and two apart against moving them in the direction across.
  double adjacent = 0., second = 0.;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d R = sheet.bond_vector(kind);
      const Eigen::Vector2d bond(stretch * R.x(), stretch_across * R.y());
      const double length = sheet.rest_length(kind);
      const double k =
        lattice::cross_section(*shell, sheet) / length * bridge::bond_tangent(shell->law, bond / length)(1, 1);
      const long rows_apart = std::lround(R.y() / pitch);
      if (rows_apart == 1)
        adjacent += k;
      else if (rows_apart == 2)
        second += k;
    }
  if (second == 0.)
    return 0.;
  // second (r + 1)^2 + adjacent r = 0, the root inside the unit circle without cancellation.
  const double b = 2. + adjacent / second;
  return -2. / (b + std::sqrt(b * b - 4.));
}

} // namespace latcon::claims
