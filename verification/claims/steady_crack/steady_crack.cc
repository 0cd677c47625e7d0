#include "verification/claims/steady_crack/steady_crack_claim.h"

#include <stdexcept>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <boost/math/tools/roots.hpp>

namespace latcon::claims
{
namespace
{

using Complex = HalfStrip::Complex;
using Eigen::Matrix2cd;
using Eigen::Vector2cd;
using Eigen::Vector2d;

const Vector2d along(1., 0.);
const Vector2d right(0.5, std::sqrt(3.) / 2.); // up and to the right
const Vector2d left(-0.5, std::sqrt(3.) / 2.); // up and to the left

// The integral of (S.8) by the midpoint rule in x, omega = scale sinh x: even steps over the slow waves of the strip,
// ever longer ones towards the fast decay at high frequencies. The integrand is even in x and analytic, so that the
// rule converges faster than any power of the step.
double logarithm_of_driving(const HalfStrip &half, std::size_t points)
{
  const CrackStrip &strip = half.strip();
  const double gamma = 1. / strip.viscosity;
  const double scale = half.speed() / static_cast<double>(strip.layers());
  const double highest = 1e4 * (1. + gamma);
  const double dx = std::asinh(highest / scale) / static_cast<double>(points);
  double sum = 0., argument = 0.;
  for (std::size_t i = 0; i < points; ++i)
  {
    const double x = (static_cast<double>(i) + 0.5) * dx;
    const double omega = scale * std::sinh(x);
    const Complex phi = half.phi(omega);
    // The argument is followed from 0 at omega = 0.
    argument += std::remainder(std::arg(phi) - argument, 2. * M_PI);
    sum += scale * std::cosh(x) * gamma / (omega * omega + gamma * gamma) *
           (std::log(std::abs(phi)) - gamma * argument / omega);
  }
  // It must come back to 0: else Phi has no factors of the kind that (S.6) needs.
  if (std::abs(argument) > 1.)
    throw std::runtime_error("the response of the strip turns around the origin: there is no steady crack");
  return sum * dx / M_PI;
}

struct Bond
{
  std::size_t row, column, far_row, far_column;
  Eigen::Vector2d direction;

  // Position along the crack, in halves of a spacing: the order in which the bonds across it break.
  std::size_t halves() const { return column + far_column; }
};

// Bonds between sites (row, column) at x = column + row/2: a sheared patch of the lattice, whose bonds have the same
// steps in every row.
std::vector<Bond> patch(std::size_t rows, std::size_t columns)
{
  std::vector<Bond> bonds;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
    {
      if (column + 1 < columns)
        bonds.push_back({row, column, row, column + 1, along});
      if (row + 1 < rows)
        bonds.push_back({row, column, row + 1, column, right});
      if (row + 1 < rows && column > 0)
        bonds.push_back({row, column, row + 1, column - 1, left});
    }
  return bonds;
}

} // namespace

double shear_speed()
{
  return std::sqrt(3. / 8.);
}

HalfStrip::HalfStrip(const CrackStrip &strip, double speed) : strip_(strip), speed_(speed)
{
  if (strip.free_rows < 1 || !(strip.viscosity > 0.) || !(speed > 0.))
    throw std::invalid_argument("a steady crack needs a free row on each side, viscosity and speed above zero");
}

// From the displacements of the rows under the forces of the bonds across the crack, by elimination from the held row
// up.
std::vector<HalfStrip::Layer> HalfStrip::elongations(double omega, std::size_t n_layers) const
{
  const Complex half_step = std::polar(1., -0.5 * omega / speed_);
  const Complex kappa = stiffness(omega);
  const Matrix2cd right_right = (right * right.transpose()).cast<Complex>();
  const Matrix2cd left_left = (left * left.transpose()).cast<Complex>();
  const Matrix2cd from_above = kappa * (right_right * half_step + left_left * std::conj(half_step));
  const Matrix2cd from_below = kappa * (right_right * std::conj(half_step) + left_left * half_step);
  const Matrix2cd one_side = kappa * (right_right + left_left);
  const double cosine = std::cos(omega / speed_);
  const Matrix2cd row =
    kappa * (2. - 2. * cosine) * (along * along.transpose()).cast<Complex>() - omega * omega * Matrix2cd::Identity();

  // compliances[j] is that of row j with all rows below it free to follow.
  const std::size_t n = strip_.free_rows;
  std::vector<Matrix2cd> compliances(n);
  for (std::size_t j = n; j-- > 0;)
  {
    Matrix2cd pivot = row + one_side;
    if (j > 0)
      pivot += one_side; // the crack leaves row 0 without bonds above
    if (j + 1 < n)
      pivot -= from_below * compliances[j + 1] * from_above;
    compliances[j] = pivot.inverse();
  }

  // The upper crack face is the mirror image (u_x, -u_y) of the lower one. A bond that goes up and to the left has the
  // elongation of one to the right, half a spacing's time earlier; the force on a site of row 0 is that of both.
  const Vector2cd mirrored(right.x(), -right.y());
  const Vector2cd of_row_0 = half_step * mirrored - right.cast<Complex>();
  const Vector2cd force = right.cast<Complex>() + left.cast<Complex>() * std::conj(half_step);
  Vector2cd above = compliances[0] * force; // displacement of the row above the gap
  const Complex step = half_step * half_step - 1.;
  const auto component = [](const Vector2d &direction, const Vector2cd &w)
  { return direction.x() * w.x() + direction.y() * w.y(); };
  const Complex across = (of_row_0.transpose() * above)(0);
  std::vector<Layer> layers{{across, across * std::conj(half_step), step * above.x()}};
  for (std::size_t j = 1; j < n_layers; ++j)
  {
    Vector2cd below = Vector2cd::Zero();
    if (j < n)
      below = compliances[j] * (from_above * above);
    layers.push_back({component(right, half_step * above - below),
                      component(left, std::conj(half_step) * above - below), step * below.x()});
    above = below;
  }
  return layers;
}

double steady_driving(const CrackStrip &strip, double speed)
{
  const HalfStrip half(strip, speed);
  constexpr double tolerance = 1e-9;
  constexpr std::size_t most = std::size_t(1) << 20;
  double coarse = logarithm_of_driving(half, std::size_t(1) << 10);
  for (std::size_t points = std::size_t(1) << 11; points <= most; points *= 2)
  {
    const double fine = logarithm_of_driving(half, points);
    if (std::abs(fine - coarse) < tolerance)
      return std::exp(fine);
    coarse = fine;
  }
  throw std::runtime_error("the integral for the driving of a steady crack does not converge");
}

double steady_speed(const CrackStrip &strip, double driving, double fastest)
{
  const auto excess = [&](double speed) { return steady_driving(strip, speed) - driving; };
  double high = fastest;
  if (!(excess(high) > 0.))
    throw std::runtime_error("a steady crack under this driving is faster than the fastest that is looked for");
  // Down from the fast end to the first speed whose driving is less.
  const double step = fastest / 64.;
  double low = high - step;
  while (low > 0.5 * step && excess(low) > 0.)
  {
    high = low;
    low -= step;
  }
  if (low <= 0.5 * step)
    throw std::runtime_error("no steady crack runs under so weak a driving");
  std::uintmax_t most = 50;
  const auto [below, above] =
    boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(35), most);
  return 0.5 * (below + above);
}

TrappingWindow trapping_window(const CrackStrip &strip, std::size_t columns)
{
  const std::size_t n = strip.free_rows, rows = 2 * n + 2;
  const std::vector<Bond> bonds = patch(rows, columns);
  const auto is_held = [&](std::size_t row) { return row == 0 || row == rows - 1; };
  const auto crosses_crack = [&](const Bond &bond) { return bond.row == n && bond.far_row == n + 1; };
  const auto first_unknown = [&](std::size_t row, std::size_t column) // first of the two of a free site
  { return static_cast<Eigen::Index>(2 * ((row - 1) * columns + column)); };
  const auto n_unknowns = static_cast<Eigen::Index>(4 * n * columns);
  const std::size_t first_whole = columns;                // of halves(): the middle of the row
  const double top = static_cast<double>(strip.layers()); // u_y of the upper row; the lower one rests

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_unknowns);
  for (const Bond &bond : bonds)
  {
    if (crosses_crack(bond) && bond.halves() < first_whole)
      continue;
    const Eigen::Matrix2d stiffness = bond.direction * bond.direction.transpose();
    const auto add = [&](std::size_t row, std::size_t column, std::size_t other_row, std::size_t other_column, int sign)
    {
      if (is_held(row))
        return;
      const Eigen::Index i = first_unknown(row, column);
      if (!is_held(other_row))
        for (Eigen::Index a = 0; a < 2; ++a)
          for (Eigen::Index b = 0; b < 2; ++b)
            entries.emplace_back(i + a, first_unknown(other_row, other_column) + b, sign * stiffness(a, b));
      else if (other_row != 0)
        load.segment<2>(i) -= sign * stiffness.col(1) * top;
    };
    add(bond.row, bond.column, bond.row, bond.column, 1);
    add(bond.far_row, bond.far_column, bond.far_row, bond.far_column, 1);
    add(bond.row, bond.column, bond.far_row, bond.far_column, -1);
    add(bond.far_row, bond.far_column, bond.row, bond.column, -1);
  }
  Eigen::SparseMatrix<double> matrix(n_unknowns, n_unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("the strip with a crack at rest has no equilibrium");
  const Eigen::VectorXd u = solver.solve(load);

  double next = 0., last = 0.;
  for (const Bond &bond : bonds)
    if (crosses_crack(bond) && bond.halves() <= first_whole && bond.halves() + 1 >= first_whole)
    {
      const Eigen::Vector2d opening =
        u.segment<2>(first_unknown(bond.far_row, bond.far_column)) - u.segment<2>(first_unknown(bond.row, bond.column));
      (bond.halves() == first_whole ? next : last) = bond.direction.dot(opening);
    }
  // Bonds of the strip ahead are elongated by sin 60 degrees for each unit of height; at Griffith's threshold by
  // 1 / sqrt(layers) of the breaking elongation.
  const double ahead = std::sqrt(3.) / 2. * top / static_cast<double>(strip.layers());
  const double threshold = 1. / std::sqrt(static_cast<double>(strip.layers()));
  return {ahead / last / threshold, ahead / next / threshold};
}

} // namespace latcon::claims
