#include "continuum/damage/gradient_forces.h"

#include "continuum/damage/instruction_sets.h"
#include "continuum/errors.h"
#include "continuum/material.h"

#include <algorithm>
#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
constexpr std::size_t node_chunk = 32; // nodes that are evaluated together

// Deformation gradient (xX, xY, yX, yY) and its gradient (xXX, xXY, xYY, yXX, yXY, yYY), stress and double stress at
// the nodes of a chunk. The double stress of XY belongs to both orders of the derivatives.
struct NodeChunk
{
  alignas(64) double F[4][node_chunk], G[6][node_chunk], P[4][node_chunk], Q[6][node_chunk], energy[node_chunk];
};

// Stiffness h(a, a) = across |a|^2 + coupling (f.a)^2 of a bond and its derivatives by s = |f|^2/2, eqs. (C.24),
// (C.27).
struct Stiffness
{
  double across, coupling, across_s, coupling_s;
};

inline __attribute__((always_inline)) Stiffness stiffness(const GradientForces::Bond &k, const double l)
{
  constexpr double shortest = FibreForces::relaxed_stretch, width = LatticeGradient::full_stretch - 1.;
  const double s = std::max(l, shortest);
  const double r = 1. / s, r2 = r * r, r3 = r2 * r, r4 = r2 * r2;
  const double first = k.a * (s - r2) + k.b * (1. - r3) + k.e * (s - 1.);
  const double second = k.a * (1. + 2. * r3) + 3. * k.b * r4 + k.e;
  const double third = -6. * k.a * r4 - 12. * k.b * r4 * r;
  const double t = std::min(std::max((s - 1.) / width, 0.), 1.);
  const double w = t * t * t * (10. - t * (15. - 6. * t));
  const double w_l = 30. * t * t * (1. - t) * (1. - t) / width;
  const double across = w * first * r;
  const double across_l = (w_l * first + w * second) * r - across * r;
  const double coupling = (second - across) * r2;
  const double coupling_l = (third - across_l) * r2 - 2. * coupling * r;
  const double inside = l > shortest ? r : 0.;
  return {across, coupling, across_l * inside, coupling_l * inside};
}

// A bond at node i of a chunk: its vector f = F N, the gradient of f along T = (-Y, X) and along N, and their products
// with f.
struct BondState
{
  double x, y, tx, ty, nx, ny, ft, fn;
  Stiffness h;
};

inline __attribute__((always_inline)) BondState bond_state(const NodeChunk &c, const GradientForces::Bond &k,
                                                           const std::size_t i)
{
  const double XX = k.X * k.X, YY = k.Y * k.Y, XY = k.X * k.Y;
  const double x = c.F[0][i] * k.X + c.F[1][i] * k.Y, y = c.F[2][i] * k.X + c.F[3][i] * k.Y;
  const Stiffness h = stiffness(k, std::sqrt(x * x + y * y));
  const double tx = XY * (c.G[2][i] - c.G[0][i]) + (XX - YY) * c.G[1][i];
  const double ty = XY * (c.G[5][i] - c.G[3][i]) + (XX - YY) * c.G[4][i];
  const double nx = XX * c.G[0][i] + 2. * XY * c.G[1][i] + YY * c.G[2][i];
  const double ny = XX * c.G[3][i] + 2. * XY * c.G[4][i] + YY * c.G[5][i];
  const double ft = x * tx + y * ty, fn = x * nx + y * ny;
  return {x, y, tx, ty, nx, ny, ft, fn, h};
}

LATCON_INSTRUCTION_SETS void add_stress(NodeChunk &c, const GradientForces::Bond &k)
{
  const double XX = k.X * k.X, YY = k.Y * k.Y, XY = k.X * k.Y;
#pragma omp simd
  for (std::size_t i = 0; i < node_chunk; ++i)
  {
    const auto [x, y, tx, ty, nx, ny, ft, fn, h] = bond_state(c, k, i);
    const double radial = 0.5 * (k.across * (h.across_s * (tx * tx + ty * ty) + h.coupling_s * ft * ft) +
                                 k.along * (h.across_s * (nx * nx + ny * ny) + h.coupling_s * fn * fn));
    const double t = k.across * h.coupling * ft, n = k.along * h.coupling * fn;
    const double px = radial * x + t * tx + n * nx, py = radial * y + t * ty + n * ny;
    c.P[0][i] += px * k.X;
    c.P[1][i] += px * k.Y;
    c.P[2][i] += py * k.X;
    c.P[3][i] += py * k.Y;
    const double qtx = k.across * h.across * tx + t * x, qty = k.across * h.across * ty + t * y;
    const double qnx = k.along * h.across * nx + n * x, qny = k.along * h.across * ny + n * y;
    c.Q[0][i] += qnx * XX - qtx * XY;
    c.Q[1][i] += 2. * qnx * XY + qtx * (XX - YY);
    c.Q[2][i] += qnx * YY + qtx * XY;
    c.Q[3][i] += qny * XX - qty * XY;
    c.Q[4][i] += 2. * qny * XY + qty * (XX - YY);
    c.Q[5][i] += qny * YY + qty * XY;
  }
}

LATCON_INSTRUCTION_SETS void add_energy(NodeChunk &c, const GradientForces::Bond &k)
{
#pragma omp simd
  for (std::size_t i = 0; i < node_chunk; ++i)
  {
    const auto [x, y, tx, ty, nx, ny, ft, fn, h] = bond_state(c, k, i);
    c.energy[i] += 0.5 * (k.across * (h.across * (tx * tx + ty * ty) + h.coupling * ft * ft) +
                          k.along * (h.across * (nx * nx + ny * ny) + h.coupling * fn * fn));
  }
}
} // namespace

std::vector<BondFamily> in_all_directions(const std::vector<BondFamily> &bonds, const unsigned int n)
{
  std::vector<BondFamily> turned;
  for (const BondFamily &bond : bonds)
    for (const FibreFamily &fibre : in_all_directions(std::vector<FibreFamily>{bond.fibre}, n))
      turned.push_back({fibre, bond.length});
  return turned;
}

GradientForces::GradientForces(const NodeGrid &grid, const std::vector<BondFamily> &bonds, const double length,
                               const Tensor<2, 2> &loading, MPI_Comm communicator)
  : grid_(grid), bands_(grid, communicator), loading_(loading)
{
  checked_determinant(loading);
  std::vector<BondFamily> merged;
  for (const BondFamily &bond : bonds)
  {
    check(bond);
    const auto same =
      std::find_if(merged.begin(), merged.end(),
                   [&](const BondFamily &other)
                   {
                     const double cosine = other.fibre.direction * bond.fibre.direction;
                     return std::abs(std::abs(cosine) - 1.) < 1e-14 && other.fibre.potential == bond.fibre.potential;
                   });
    if (same == merged.end())
    {
      merged.push_back(bond);
      continue;
    }
    const double c = same->fibre.weight, own = bond.fibre.weight;
    same->length = std::sqrt((c * same->length * same->length + own * bond.length * bond.length) / (c + own));
    same->fibre.weight = c + own;
  }
  // Checks the length, with its tolerance for rounding.
  const LatticeGradient law(merged, length);
  for (const BondFamily &family : merged)
  {
    const FibreFamily &fibre = family.fibre;
    Bond bond{fibre.direction[0],
              fibre.direction[1],
              0.,
              0.,
              0.,
              length * length,
              std::max(0., length * length - family.length * family.length / 12.)};
    if (const auto *rod = std::get_if<RodPotential>(&fibre.potential))
    {
      bond.a = fibre.weight * rod->a;
      bond.b = fibre.weight * rod->b;
    }
    else if (const auto *spring = std::get_if<LinearPotential>(&fibre.potential))
      bond.e = fibre.weight * spring->e;
    else
      throw InvalidInput("a sheet in motion with damage does not support user-defined bond laws");
    bonds_.push_back(bond);
  }
}

template <bool is_force>
struct GradientForces::Row
{
  std::size_t j; // row of nodes, inside
  const GridVector &u;
  const std::vector<double> *factors;
  GridVector *force;
  std::vector<double> *energies;
};

template <bool is_force>
void GradientForces::visit(const Row<is_force> &row) const
{
  const std::size_t columns = grid_.columns();
  const double area = grid_.area(), rx = 1. / grid_.size_x, ry = 1. / grid_.size_y;
  NodeChunk c{};
  for (std::size_t first = 1; first < grid_.cells_x; first += node_chunk)
  {
    const std::size_t n = std::min(node_chunk, grid_.cells_x - first);
    const std::size_t node = row.j * columns + first;
    for (unsigned int d = 0; d < 2; ++d)
    {
      const double *here = row.u[d].data() + node, *low = here - columns, *high = here + columns;
      for (std::size_t i = 0; i < n; ++i)
      {
        c.F[2 * d][i] = 0.5 * rx * (here[i + 1] - here[static_cast<std::ptrdiff_t>(i) - 1]) + loading_[d][0];
        c.F[2 * d + 1][i] = 0.5 * ry * (high[i] - low[i]) + loading_[d][1];
        c.G[3 * d][i] = rx * rx * ((here[i + 1] - here[i]) - (here[i] - here[static_cast<std::ptrdiff_t>(i) - 1]));
        c.G[3 * d + 1][i] = 0.25 * rx * ry *
                            ((high[i + 1] - high[static_cast<std::ptrdiff_t>(i) - 1]) -
                             (low[i + 1] - low[static_cast<std::ptrdiff_t>(i) - 1]));
        c.G[3 * d + 2][i] = ry * ry * ((high[i] - here[i]) - (here[i] - low[i]));
      }
      for (std::size_t i = n; i < node_chunk; ++i)
      {
        c.F[2 * d][i] = loading_[d][0];
        c.F[2 * d + 1][i] = loading_[d][1];
        c.G[3 * d][i] = c.G[3 * d + 1][i] = c.G[3 * d + 2][i] = 0.;
      }
    }
    if constexpr (is_force)
    {
      std::fill(&c.P[0][0], &c.P[0][0] + 4 * node_chunk, 0.);
      std::fill(&c.Q[0][0], &c.Q[0][0] + 6 * node_chunk, 0.);
      for (const Bond &k : bonds_)
        add_stress(c, k);
      for (unsigned int d = 0; d < 2; ++d)
      {
        double *here = (*row.force)[d].data() + node, *low = here - columns, *high = here + columns;
        for (std::size_t i = 0; i < n; ++i)
        {
          const auto left = static_cast<std::ptrdiff_t>(i) - 1;
          const double weight = -area * (*row.factors)[node + i];
          const double X = 0.5 * rx * weight * c.P[2 * d][i], Y = 0.5 * ry * weight * c.P[2 * d + 1][i];
          const double XX = rx * rx * weight * c.Q[3 * d][i], XY = 0.25 * rx * ry * weight * c.Q[3 * d + 1][i],
                       YY = ry * ry * weight * c.Q[3 * d + 2][i];
          low[left] += XY;
          low[i] += YY - Y;
          low[i + 1] -= XY;
          here[left] += XX - X;
          here[i] -= 2. * (XX + YY);
          here[i + 1] += XX + X;
          high[left] -= XY;
          high[i] += YY + Y;
          high[i + 1] += XY;
        }
      }
    }
    else
    {
      std::fill(c.energy, c.energy + node_chunk, 0.);
      for (const Bond &k : bonds_)
        add_energy(c, k);
      for (std::size_t i = 0; i < n; ++i)
        (*row.energies)[node + i] = area * c.energy[i];
    }
  }
}

void GradientForces::add_forces(const GridVector &u, const std::vector<double> &factors, GridVector &force) const
{
  // The inner rows that reach the own nodes. Every third row: these share no nodes. Each node adds up its rows in the
  // order of their remainders 1, 2, 0, whatever the number of threads.
  const std::size_t begin = std::max<std::size_t>(bands_.begin(), 2) - 1,
                    end = std::min(bands_.end() + 1, grid_.cells_y);
  for (const std::size_t remainder : {1u, 2u, 0u})
  {
#pragma omp parallel for schedule(static) if (grid_.n_cells() >= FibreForces::min_cells_for_threads)
    for (std::size_t j = begin + (remainder + 3 - begin % 3) % 3; j < end; j += 3)
      visit(Row<true>{j, u, &factors, &force, nullptr});
  }
  for (std::vector<double> &component : force)
    bands_.gather_nodes(component);
}

void GradientForces::energies(const GridVector &u, std::vector<double> &node_energies) const
{
  node_energies.assign(grid_.n_nodes(), 0.);
#pragma omp parallel for schedule(static) if (grid_.n_cells() >= FibreForces::min_cells_for_threads)
  for (std::size_t j = std::max<std::size_t>(bands_.begin(), 1); j < bands_.cells_end(); ++j)
    visit(Row<false>{j, u, nullptr, nullptr, &node_energies});
  bands_.gather_nodes(node_energies);
}

std::vector<GradientForces::PatchTerm> GradientForces::patch_terms(const double relaxed) const
{
  const double xx = 1. / (grid_.size_x * grid_.size_x), yy = 1. / (grid_.size_y * grid_.size_y),
               xy = 0.25 / grid_.area();
  const std::array<double, 9> XX{0., 0., 0., xx, -2. * xx, xx, 0., 0., 0.};
  const std::array<double, 9> YY{0., yy, 0., 0., -2. * yy, 0., 0., yy, 0.};
  const std::array<double, 9> XY{xy, 0., -xy, 0., 0., 0., -xy, 0., xy};
  std::vector<PatchTerm> terms;
  for (const Bond &k : bonds_)
  {
    const double l = (loading_ * Tensor<1, 2>({k.X, k.Y})).norm();
    const double shortest = std::min(l, relaxed);
    const Stiffness loaded = stiffness(k, l), unloaded = stiffness(k, shortest);
    const double largest = std::max(loaded.across, unloaded.across + unloaded.coupling * shortest * shortest);
    PatchTerm across{{}, largest * k.across}, along{{}, largest * k.along};
    for (unsigned int b = 0; b < 9; ++b)
    {
      across.S[b] = k.X * k.Y * (YY[b] - XX[b]) + (k.X * k.X - k.Y * k.Y) * XY[b];
      along.S[b] = k.X * k.X * XX[b] + 2. * k.X * k.Y * XY[b] + k.Y * k.Y * YY[b];
    }
    terms.push_back(across);
    terms.push_back(along);
  }
  return terms;
}
} // namespace latcon::continuum
