#include "lattice/scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lattice/counter_hash.h"
#include "lattice/triangular_lattice.h"
#include "support/dense.h"

namespace latcon::lattice
{
namespace
{

constexpr Eigen::Index n_of_point = 5, n_common = 4; // unknowns
constexpr double tolerance = 1e-11;                  // rms of the equations of a point, whose terms are of order 1
constexpr double softness = 0.01; // multiplier of odd harmonics times this is what remains of their sums
constexpr int most_steps = 60, most_iterations = 2000;

// A bond that may have a weight: tent * exp(mu_near . of_point + mu_far . (far end's) + nu . common).
struct Link
{
  std::size_t place, kind;
  std::ptrdiff_t near, far; // numbers of the points; negative: beyond an edge
  double weight;            // at first that of the tent
  Eigen::Matrix<double, n_of_point, 1>
    of_point;                                // 1 and odd harmonics over the length; these are opposite at the far end
  Eigen::Matrix<double, n_common, 1> common; // even harmonics
};

// Weights of greatest entropy of one ring: the minimum of a convex function of the multipliers mu and nu.
class RingWeights
{
public:
  RingWeights(std::vector<Link> &links, std::size_t n_points)
    : links_(links), n_(static_cast<Eigen::Index>(n_points)), size_(n_of_point * n_ + n_common)
  {
    double sum = 0.;
    for (const Link &link : links_)
      sum += link.weight * ((link.near >= 0) + (link.far >= 0));
    for (Link &link : links_)
      link.weight *= 2. * static_cast<double>(n_points) / sum;
  }

  void solve()
  {
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(size_), residual = equations(multipliers);
    for (int step = 0; residual.norm() > tolerance * std::sqrt(static_cast<double>(size_)); ++step)
    {
      if (step == most_steps || !residual.allFinite())
        throw std::invalid_argument(
          "the points are too scattered for positive weights: less scatter or a finer grid is needed");
      const Eigen::VectorXd direction = newton_direction(residual);
      const double slope = residual.dot(direction), before = function(multipliers, direction, 0.);
      double share = 1.;
      while (share > 1e-6 &&
             !(function(multipliers, direction, share) <= before + 0.1 * share * slope + 1e-12 * before))
        share *= 0.5;
      for (Link &link : links_)
        link.weight *= std::exp(share * along(link, direction));
      multipliers += share * direction;
      residual = equations(multipliers);
    }
  }

private:
  // Changes of the exponent of a bond with the multipliers, and the transpose.
  double along(const Link &link, const Eigen::VectorXd &x) const
  {
    double sum = link.common.dot(x.tail<n_common>());
    if (link.near >= 0)
      sum += link.of_point.dot(x.segment<n_of_point>(n_of_point * link.near));
    if (link.far >= 0)
      sum += 2. * x[n_of_point * link.far] - link.of_point.dot(x.segment<n_of_point>(n_of_point * link.far));
    return sum;
  }
  void add(const Link &link, double value, Eigen::VectorXd &x) const
  {
    x.tail<n_common>() += value * link.common;
    if (link.near >= 0)
      x.segment<n_of_point>(n_of_point * link.near) += value * link.of_point;
    if (link.far >= 0)
    {
      x.segment<n_of_point>(n_of_point * link.far) -= value * link.of_point;
      x[n_of_point * link.far] += 2. * value;
    }
  }

  // The minimised function after a share of a step.
  double function(const Eigen::VectorXd &multipliers, const Eigen::VectorXd &direction, double share) const
  {
    double sum = 0.;
    for (const Link &link : links_)
      sum += link.weight * std::exp(share * along(link, direction));
    const Eigen::VectorXd at = multipliers + share * direction;
    for (Eigen::Index i = 0; i < n_; ++i)
      sum += 0.5 * softness * at.segment<n_of_point - 1>(n_of_point * i + 1).squaredNorm() - 2. * at[n_of_point * i];
    return sum;
  }

  // Its gradient.
  Eigen::VectorXd equations(const Eigen::VectorXd &multipliers) const
  {
    Eigen::VectorXd sums = soft(multipliers);
    for (Eigen::Index i = 0; i < n_; ++i)
      sums[n_of_point * i] = -2.;
    for (const Link &link : links_)
      add(link, link.weight, sums);
    return sums;
  }

  // The part of the gradient that is proportional to the multipliers, those of odd harmonics.
  Eigen::VectorXd soft(const Eigen::VectorXd &multipliers) const
  {
    Eigen::VectorXd sums = softness * multipliers;
    for (Eigen::Index i = 0; i < n_; ++i)
      sums[n_of_point * i] = 0.;
    sums.tail<n_common>().setZero();
    return sums;
  }

  // Conjugate gradients, preconditioned by the blocks of the points.
  Eigen::VectorXd newton_direction(const Eigen::VectorXd &equations) const
  {
    std::vector<Eigen::Matrix<double, n_of_point, n_of_point>> blocks(static_cast<std::size_t>(n_));
    for (auto &block : blocks)
      block = softness * block.Identity();
    Eigen::Matrix<double, n_common, n_common> common = common.Zero();
    for (const Link &link : links_)
    {
      Eigen::Matrix<double, n_of_point, 1> end = link.of_point;
      if (link.near >= 0)
        blocks[static_cast<std::size_t>(link.near)] += link.weight * end * end.transpose();
      end.tail<n_of_point - 1>() *= -1.;
      if (link.far >= 0)
        blocks[static_cast<std::size_t>(link.far)] += link.weight * end * end.transpose();
      common += link.weight * link.common * link.common.transpose();
    }
    for (auto &block : blocks)
      block = support::solve_positive(block, block.Identity());
    common = support::solve_positive(common, common.Identity());
    const auto preconditioned = [&](const Eigen::VectorXd &of)
    {
      Eigen::VectorXd result(size_);
      for (Eigen::Index i = 0; i < n_; ++i)
        result.segment<n_of_point>(n_of_point * i) =
          blocks[static_cast<std::size_t>(i)] * of.segment<n_of_point>(n_of_point * i);
      result.tail<n_common>() = common * of.tail<n_common>();
      return result;
    };

    Eigen::VectorXd x = Eigen::VectorXd::Zero(size_), residual = -equations, z = preconditioned(residual), p = z;
    double rz = residual.dot(z);
    const double rms = residual.norm() / std::sqrt(static_cast<double>(size_));
    const double wanted = std::min(0.1, rms) * residual.norm();
    for (int iteration = 0; iteration < most_iterations && residual.norm() > wanted; ++iteration)
    {
      Eigen::VectorXd Hp = soft(p);
      for (const Link &link : links_)
        add(link, link.weight * along(link, p), Hp);
      const double step = rz / p.dot(Hp);
      x += step * p;
      residual -= step * Hp;
      z = preconditioned(residual);
      const double next = residual.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
    return x;
  }

  std::vector<Link> &links_;
  Eigen::Index n_, size_;
};

} // namespace

Eigen::Vector2d Scatter::displacement(std::ptrdiff_t row, std::ptrdiff_t column) const
{
  const std::uint64_t point = static_cast<std::uint64_t>(row) << 32u | static_cast<std::uint32_t>(column),
                      key = splitmix64(splitmix64(splitmix64(seed) + 3) + point);
  return amplitude * Eigen::Vector2d(symmetric_uniform(splitmix64(key)), symmetric_uniform(splitmix64(key + 1)));
}

std::vector<HalfBond> scattered_stencil(const Grid &grid, const std::vector<Ring> &rings, const Scatter &scatter)
{
  const double h = grid.spacing, width = (1. + std::sqrt(8.) * scatter.amplitude) * h;
  std::vector<HalfBond> stencil;
  for (const Ring &ring : rings)
  {
    const int rows = static_cast<int>(std::ceil(1.2 * (ring.radius + width) / h)), columns = 2 * rows;
    for (int row = 0; row <= rows; ++row)
      for (int column = columns; column >= (row == 0 ? 1 : -columns); --column)
        if (const Eigen::Vector2d R = grid.vector(column, row); std::abs(R.norm() - ring.radius) < width)
          stencil.push_back({column, row, R, R.norm(), 1., ring.shell, ring.radius});
  }
  return stencil;
}

ScatteredBonds::ScatteredBonds(const TriangularLattice &lattice)
  : weights(lattice.n_kinds(), std::vector<double>(lattice.n_places())), length_ratios(weights),
    bounding_weights(lattice.n_kinds()), shortest(std::numeric_limits<double>::infinity())
{
  const double h = lattice.spacing();
  std::vector<std::ptrdiff_t> number(lattice.n_places(), -1);
  std::vector<Eigen::Vector2d> points(lattice.n_places());
  std::ptrdiff_t n = 0;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
  {
    points[place] = lattice.reference(place);
    if (lattice.is_site(place))
      number[place] = n++;
  }
  for (const TriangularLattice::Image &image : lattice.images())
    number[image.place] = number[image.site];

  for (std::size_t first = 0, end = 0; first < lattice.n_kinds(); first = end)
  {
    const double radius = lattice.ring_radius(first);
    while (end < lattice.n_kinds() && lattice.ring_radius(end) == radius && lattice.shell(end) == lattice.shell(first))
      ++end;
    std::vector<Link> links;
    for (std::size_t place = 0; place < lattice.n_places(); ++place)
      for (std::size_t kind = first; kind < end; ++kind)
      {
        const std::size_t far = lattice.bond(place, kind).far;
        if (far >= lattice.n_places() || (number[place] < 0 && number[far] < 0) ||
            (!lattice.images().empty() && !lattice.is_site(place)))
          continue;
        const Eigen::Vector2d R = points[far] - points[place];
        const double length = R.norm(), weight = 1. - std::abs(length - radius) / h, angle = std::atan2(R.y(), R.x()),
                     share = radius / length;
        if (!(weight > 1e-9))
          continue;
        links.push_back({place, kind, number[place], number[far], weight, {}, {}});
        links.back().of_point << 1., share * std::cos(angle), share * std::sin(angle), share * std::cos(3. * angle),
          share * std::sin(3. * angle);
        links.back().common << std::cos(2. * angle), std::sin(2. * angle), std::cos(4. * angle), std::sin(4. * angle);
        length_ratios[kind][place] = lattice.rest_length(kind) / length;
        shortest = std::min(shortest, length);
      }
    RingWeights(links, static_cast<std::size_t>(n)).solve();

    std::vector<double> crowding(static_cast<std::size_t>(n), 0.);
    for (const Link &link : links)
    {
      weights[link.kind][link.place] = link.weight;
      const double length = lattice.rest_length(link.kind) / length_ratios[link.kind][link.place];
      for (const std::ptrdiff_t point : {link.near, link.far})
        if (point >= 0)
        {
          crowding[static_cast<std::size_t>(point)] += 0.5 * link.weight / (length * length);
          bonds_of_point += 1. / static_cast<double>(n);
        }
    }
    for (std::size_t kind = first; kind < end; ++kind)
      bounding_weights[kind] = *std::max_element(crowding.begin(), crowding.end()) *
                               std::pow(lattice.rest_length(kind), 2) / static_cast<double>(end - first);
  }
}

} // namespace latcon::lattice
