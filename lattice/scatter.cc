#include "lattice/scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCore>

#include "lattice/triangular_lattice.h"
#include "support/require.h"

namespace latcon::lattice
{
namespace
{

constexpr Eigen::Index n_of_point = 5, n_common = 4; // unknowns
constexpr double tolerance = 1e-11;                  // rms of the equations of a point, whose terms are of order 1
constexpr double softness = 0.01; // multiplier of odd harmonics times this is what remains of their sums
constexpr int most_steps = 60, most_iterations = 2000;

// Exponents of the weights of bonds, one a row, are linear in the multipliers: those of each point, for its sum and for
// its odd harmonics, and those common to all, for the even harmonics.
using Exponents = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// x of (J^T diag(weights) J + diag(soft)) x = right, by conjugate gradients with the diagonal as preconditioner.
Eigen::VectorXd newton_direction(const Exponents &J, const Eigen::VectorXd &weights, const Eigen::VectorXd &soft,
                                 const Eigen::VectorXd &right)
{
  const Eigen::VectorXd diagonal = J.cwiseAbs2().transpose() * weights + soft;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size()), residual = right, z = residual.cwiseQuotient(diagonal),
                  p = z;
  double rz = residual.dot(z);
  const double rms = residual.norm() / std::sqrt(static_cast<double>(right.size()));
  const double wanted = std::min(0.1, rms) * residual.norm();
  for (int iteration = 0; iteration < most_iterations && residual.norm() > wanted; ++iteration)
  {
    const Eigen::VectorXd Hp = J.transpose() * weights.cwiseProduct(J * p) + soft.cwiseProduct(p);
    const double step = rz / p.dot(Hp);
    x += step * p;
    residual -= step * Hp;
    z = residual.cwiseQuotient(diagonal);
    const double next = residual.dot(z);
    p = z + next / rz * p;
    rz = next;
  }
  return x;
}

// Turns the weights of the tent into those of greatest entropy of one ring, which minimise a convex function of the
// multipliers, by Newton's method.
void maximise_entropy(const Exponents &J, Eigen::VectorXd &weights)
{
  const Eigen::Index size = J.cols();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(size); // 1 at the multipliers of the sums at points
  for (Eigen::Index i = 0; i + n_common < size; i += n_of_point)
    sums[i] = 1.;
  Eigen::VectorXd soft = softness * (Eigen::VectorXd::Ones(size) - sums); // at those of odd harmonics
  soft.tail<n_common>().setZero();
  weights *= 2. * sums.sum() / weights.dot(J * sums);
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(size);
  for (int step = 0;; ++step)
  {
    const Eigen::VectorXd residual = J.transpose() * weights + soft.cwiseProduct(multipliers) - 2. * sums;
    if (residual.norm() <= tolerance * std::sqrt(static_cast<double>(size)))
      return;
    support::require(step < most_steps && residual.allFinite(),
                     "the points are too scattered for positive weights: less scatter or a finer grid is needed");
    const Eigen::VectorXd direction = newton_direction(J, weights, soft, -residual), along = J * direction;
    const auto function = [&](double share)
    {
      const Eigen::VectorXd at = multipliers + share * direction;
      return weights.dot((share * along).array().exp().matrix()) + 0.5 * soft.dot(at.cwiseAbs2()) - 2. * sums.dot(at);
    };
    const double slope = residual.dot(direction), before = function(0.);
    double share = 1.;
    while (share > 1e-6 && !(function(share) <= before + 0.1 * share * slope + 1e-12 * before))
      share *= 0.5;
    weights.array() *= (share * along).array().exp();
    multipliers += share * direction;
  }
}

} // namespace

ScatteredBonds::ScatteredBonds(const TriangularLattice &lattice)
  : weights(lattice.n_kinds(), std::vector<double>(lattice.n_places())), length_ratios(weights),
    bounding_weights(lattice.n_kinds()), shortest(std::numeric_limits<double>::infinity())
{
  const double h = lattice.spacing();
  const auto n = static_cast<std::ptrdiff_t>(lattice.n_sites());
  std::vector<std::ptrdiff_t> number(lattice.n_places(), -1); // of points; negative: beyond an edge
  std::vector<Eigen::Vector2d> points;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
  {
    points.push_back(lattice.reference(place));
    if (lattice.is_occupied(place))
      number[place] = static_cast<std::ptrdiff_t>(lattice.site_number(lattice.canonical_place(place)));
  }

  for (std::size_t first = 0, end = 0; first < lattice.n_kinds(); first = end)
  {
    const double radius = lattice.ring_radius(first);
    while (end < lattice.n_kinds() && lattice.ring_radius(end) == radius && lattice.shell(end) == lattice.shell(first))
      ++end;
    std::vector<Bond> links;
    std::vector<double> tents, squares; // of lengths
    std::vector<Eigen::Triplet<double, std::ptrdiff_t>> exponents;
    for (std::size_t place = 0; place < lattice.n_places(); ++place)
      for (std::size_t kind = first; kind < end; ++kind)
      {
        const Bond link = lattice.bond(place, kind);
        const std::size_t far = link.far;
        if (far >= lattice.n_places() || (number[place] < 0 && number[far] < 0) ||
            (!lattice.images().empty() && !lattice.is_site(place)))
          continue;
        const Eigen::Vector2d R = points[far] - points[place];
        const double length = R.norm(), weight = 1. - std::abs(length - radius) / h, angle = std::atan2(R.y(), R.x());
        if (!(weight > 1e-9))
          continue;
        const auto row = static_cast<std::ptrdiff_t>(links.size());
        const auto add_harmonic = [&](std::ptrdiff_t column, int order, double factor)
        {
          exponents.emplace_back(row, column, factor * std::cos(order * angle));
          exponents.emplace_back(row, column + 1, factor * std::sin(order * angle));
        };
        links.push_back(link);
        tents.push_back(weight);
        // Odd harmonics are opposite at the far end.
        for (const auto &[point, sense] : {std::pair(number[place], 1.), std::pair(number[far], -1.)})
          if (point >= 0)
          {
            bonds_of_point += 1. / static_cast<double>(n);
            exponents.emplace_back(row, n_of_point * point, 1.);
            for (const int order : {1, 3})
              add_harmonic(n_of_point * point + order, order, sense * radius / length);
          }
        for (const int order : {2, 4})
          add_harmonic(n_of_point * n + order - 2, order, 1.);
        length_ratios[kind][place] = lattice.rest_length(kind) / length;
        squares.push_back(std::pow(lattice.rest_length(kind) / length_ratios[kind][place], 2)); // as forces have it
        shortest = std::min(shortest, length);
      }
    Exponents J(static_cast<Eigen::Index>(links.size()), n_of_point * n + n_common);
    J.setFromTriplets(exponents.begin(), exponents.end());
    Eigen::VectorXd of_links = Eigen::VectorXd::Map(tents.data(), J.rows());
    maximise_entropy(J, of_links);
    for (std::size_t i = 0; i < links.size(); ++i)
      weights[links[i].kind][links[i].near] = of_links[static_cast<Eigen::Index>(i)];

    // Sums of q / |R|^2 over the half-bonds of points: columns of their sums.
    const Eigen::VectorXd crowding =
      J.transpose() * (0.5 * of_links.cwiseQuotient(Eigen::VectorXd::Map(squares.data(), J.rows())));
    const double largest = crowding.head(n_of_point * n).reshaped(n_of_point, n).row(0).maxCoeff();
    for (std::size_t kind = first; kind < end; ++kind)
      bounding_weights[kind] = largest * std::pow(lattice.rest_length(kind), 2) / static_cast<double>(end - first);
  }
}

} // namespace latcon::lattice
