#include "verification/bridge/nonlocal_continuum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "verification/bridge/small_strain.h"

namespace latcon::bridge
{
namespace
{

using lattice::Grid;
using lattice::HalfBond;
using lattice::Shell;

// Sums of c f(l) over rings, c being the energy per area of psi. @param scatter of a ring at h = l
RingValue sum_over_rings(const lattice::Material &material, double d, double h, double scatter,
                         const std::function<double(const Shell &)> &factor,
                         const std::function<std::pair<double, double>(double)> &limit_and_second_order)
{
  RingValue sum{0., 0., 0.};
  for (const lattice::Ring &ring : rings_of(material, d, lattice::Orientation::rows_along_crack))
  {
    const Shell &shell = *material.in_shell(ring.shell);
    const double c = ring_weight(material, d, ring) * factor(shell);
    const auto [limit, second_order] = limit_and_second_order(ring.radius);
    sum.limit += c * limit;
    sum.smooth += c * (limit + second_order);
    sum.scatter += std::abs(c * limit) * scatter * std::pow(h / ring.radius, 1.5);
  }
  return sum;
}

double stiffness_at_rest(const Shell &shell)
{
  return lattice::stiffness(shell.law, 1.);
}

} // namespace

std::vector<lattice::Ring> rings_of(const lattice::Material &material, double d, lattice::Orientation orientation,
                                    double half_width)
{
  std::vector<lattice::Ring> rings = lattice::lattice_rings(d, orientation, half_width);
  rings.push_back({2. * d, rings[0].direction, 2, half_width});
  rings.erase(std::remove_if(rings.begin(), rings.end(),
                             [&](const lattice::Ring &ring) { return material.in_shell(ring.shell) == nullptr; }),
              rings.end());
  return rings;
}

double ring_weight(const lattice::Material &material, double d, const lattice::Ring &ring)
{
  return 3. * material.in_shell(ring.shell)->area_factor * ring.radius / d;
}

NonlocalContinuum::NonlocalContinuum(std::vector<HalfBond> stencil, const lattice::Material &material, double d)
  : stencil_(std::move(stencil)), material_(material), d_(d)
{
  stencil_.erase(std::remove_if(stencil_.begin(), stencil_.end(),
                                [&](const HalfBond &bond) { return material.in_shell(bond.shell) == nullptr; }),
                 stencil_.end());
}

double NonlocalContinuum::weight(const HalfBond &bond) const
{
  return 3. * shell(bond).area_factor * bond.radius / d_ * bond.weight;
}

double NonlocalContinuum::energy(const Eigen::Matrix2d &F) const
{
  double sum = 0.;
  for (const HalfBond &bond : stencil_)
    sum += weight(bond) * lattice::energy(shell(bond).law, (F * bond.vector).norm() / bond.rest_length);
  return sum;
}

Eigen::Matrix2d NonlocalContinuum::first_piola_stress(const Eigen::Matrix2d &F) const
{
  Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
  for (const HalfBond &bond : stencil_)
  {
    const Eigen::Vector2d N = bond.vector / bond.rest_length, n = F * N;
    stress += weight(bond) * lattice::force(shell(bond).law, n.norm()) / n.norm() * n * N.transpose();
  }
  return stress;
}

Eigen::Matrix2d NonlocalContinuum::wave_stiffness(const Eigen::Matrix2d &F, const Eigen::Vector2d &K) const
{
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  for (const HalfBond &bond : stencil_)
  {
    const double phase = std::pow(2. * std::sin(0.5 * K.dot(bond.vector)) / bond.rest_length, 2);
    matrix +=
      weight(bond) * phase / material_.density * bond_tangent(shell(bond).law, F * bond.vector / bond.rest_length);
  }
  return matrix;
}

double NonlocalContinuum::squared_length() const
{
  double sum = 0., stiffness = 0.;
  for (const HalfBond &bond : stencil_)
  {
    const double c = weight(bond) * stiffness_at_rest(shell(bond));
    stiffness += c;
    sum += c * bond.rest_length * bond.rest_length;
  }
  return sum / stiffness;
}

double NonlocalContinuum::cut_energy(double stretch) const
{
  double sum = 0.;
  for (const HalfBond &bond : stencil_)
    sum += weight(bond) * lattice::energy(shell(bond).law, stretch) * std::abs(bond.vector.y());
  return sum;
}

RingValue ring_squared_length(const lattice::Material &material, double d, const Grid &grid)
{
  const double h = grid.spacing;
  // Largest of 675 rings from l = 1.5 h to 15 h, of weights of ring_stencil(): 0.11 and 0.18.
  const double scatter = grid.kind == Grid::Kind::square ? 0.12 : 0.19;
  const RingValue sum = sum_over_rings(material, d, h, scatter, stiffness_at_rest,
                                       [h](double l) { return std::pair(l * l, 0.5 * h * h); });
  const double stiffness =
    sum_over_rings(material, d, h, 0., stiffness_at_rest, [](double) { return std::pair(1., 0.); }).limit;
  return {sum.limit / stiffness, sum.smooth / stiffness, sum.scatter / stiffness};
}

RingValue ring_cut_energy(const lattice::Material &material, double d, const Grid &grid, double stretch)
{
  const double h = grid.spacing;
  const bool is_square = grid.kind == Grid::Kind::square;
  // Distance of the lines of points that are parallel to x.
  const double lines =
    h * (is_square ? 1. : grid.orientation == lattice::Orientation::rows_along_crack ? lattice::half_sqrt3 : 0.5);
  // Largest of the same rings: 0.047 and 0.104.
  const double scatter = is_square ? 0.05 : 0.11;
  return sum_over_rings(
    material, d, h, scatter, [&](const Shell &shell) { return lattice::energy(shell.law, stretch); },
    [&](double l)
    {
      const double limit = 2. / M_PI * l;
      return std::pair(limit, limit * (2. * h * h - lines * lines) / (12. * l * l));
    });
}

} // namespace latcon::bridge
