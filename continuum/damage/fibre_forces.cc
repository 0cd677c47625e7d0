#include "continuum/damage/fibre_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "continuum/damage/instruction_sets.h"
#include "continuum/errors.h"
#include "continuum/material.h"
#include "support/dense.h"

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
constexpr std::size_t chunk = 32; // cells that are evaluated together
constexpr double gauss[2] = {0.21132486540518711775, 0.78867513459481288225};

template <class Family>
std::vector<Family> turned(const std::vector<Family> &families, const unsigned int n)
{
  if (n < 6)
    throw InvalidInput("fibres in all directions need six directions or more");
  std::vector<Family> fibres;
  for (const Family &family : families)
    for (unsigned int k = 0; k < n; ++k)
    {
      const double angle = std::acos(-1.) * k / n;
      Family turned = family;
      turned.direction = Tensor<1, 2>({std::cos(angle), std::sin(angle)});
      turned.weight /= n;
      fibres.push_back(turned);
    }
  return fibres;
}

// Deformation gradient, its rate and stress at one Gauss point of a chunk of cells, component by component.
struct Chunk
{
  alignas(64) double F[4][chunk], rate[4][chunk], P[4][chunk], energy[chunk], power[chunk], shortest[chunk];
};

// Adds the stress of a fibre, and its dissipation. See FibreForces for the lower bound of the stretch.
LATCON_INSTRUCTION_SETS void add_stress(Chunk &c, const DampedFibre &k, const double min_stretch)
{
#pragma omp simd
  for (std::size_t i = 0; i < chunk; ++i)
  {
    const double x = c.F[0][i] * k.X + c.F[1][i] * k.Y, y = c.F[2][i] * k.X + c.F[3][i] * k.Y;
    const double l = std::sqrt(x * x + y * y + 1e-60);
    const double inverse = 1. / l;
    const double s = std::max(l, min_stretch);
    const double r = 1. / s;
    const double speed =
      ((c.rate[0][i] * k.X + c.rate[1][i] * k.Y) * x + (c.rate[2][i] * k.X + c.rate[3][i] * k.Y) * y) * inverse;
    const double viscous = k.eta * speed;
    const double force = (k.a * (s - r * r) + k.b * (1. - r * r * r) + k.e * (s - 1.) + viscous) * inverse;
    c.P[0][i] += force * x * k.X;
    c.P[1][i] += force * x * k.Y;
    c.P[2][i] += force * y * k.X;
    c.P[3][i] += force * y * k.Y;
    c.power[i] += viscous * speed;
  }
}

// Adds the energy of a fibre.
LATCON_INSTRUCTION_SETS void add_energy(Chunk &c, const DampedFibre &k, const double min_stretch)
{
#pragma omp simd
  for (std::size_t i = 0; i < chunk; ++i)
  {
    const double x = c.F[0][i] * k.X + c.F[1][i] * k.Y, y = c.F[2][i] * k.X + c.F[3][i] * k.Y;
    const double l = std::sqrt(x * x + y * y);
    const double s = std::max(l, min_stretch);
    const double r = 1. / s;
    const double force = k.a * (s - r * r) + k.b * (1. - r * r * r) + k.e * (s - 1.);
    c.energy[i] +=
      k.a * (0.5 * s * s + r - 1.5) + k.b * (s + 0.5 * r * r - 1.5) + 0.5 * k.e * (s - 1.) * (s - 1.) + force * (l - s);
    c.shortest[i] = std::min(c.shortest[i], l);
  }
}
} // namespace

std::vector<FibreFamily> in_all_directions(const std::vector<FibreFamily> &families, const unsigned int n)
{
  return turned(families, n);
}

std::vector<FibreDashpot> in_all_directions(const std::vector<FibreDashpot> &dashpots, const unsigned int n)
{
  return turned(dashpots, n);
}

FibreForces::FibreForces(const NodeGrid &grid, const std::vector<FibreFamily> &families,
                         const std::vector<FibreDashpot> &dashpots, const Tensor<2, 2> &loading, MPI_Comm communicator)
  : grid_(grid), bands_(grid, communicator), loading_(loading)
{
  if (families.empty())
    throw InvalidMaterial("a fibre network needs at least one family");
  checked_determinant(loading);
  for (const FibreFamily &family : families)
  {
    check(family);
    DampedFibre &fibre = fibre_along(family.direction);
    if (const auto *rod = std::get_if<RodPotential>(&family.potential))
    {
      fibre.a += family.weight * rod->a;
      fibre.b += family.weight * rod->b;
    }
    else if (const auto *spring = std::get_if<LinearPotential>(&family.potential))
      fibre.e += family.weight * spring->e;
    else
      throw InvalidInput("a sheet in motion with damage does not support user-defined bond laws");
  }
  for (const FibreDashpot &dashpot : dashpots)
  {
    check(dashpot);
    fibre_along(dashpot.direction).eta += dashpot.weight * dashpot.viscosity;
  }
}

DampedFibre &FibreForces::fibre_along(const Tensor<1, 2> &direction)
{
  for (DampedFibre &fibre : fibres_)
    if (std::abs(std::abs(fibre.X * direction[0] + fibre.Y * direction[1]) - 1.) < 1e-14)
      return fibre;
  return fibres_.emplace_back(DampedFibre{direction[0], direction[1], 0., 0., 0., 0.});
}

template <bool is_force>
struct FibreForces::Row
{
  std::size_t j;
  const GridVector &u, &v;
  const std::vector<double> &factors;
  GridVector *force;
  std::vector<double> *energies;
  double *power;   // of the row
  double *unsound; // first unsound cell of the row, a number for gathering
};

template <bool is_force>
void FibreForces::visit(const Row<is_force> &row) const
{
  const std::size_t columns = grid_.columns();
  const double weight = 0.25 * grid_.area(), rx = 1. / grid_.size_x, ry = 1. / grid_.size_y;
  Chunk c{};
  double nodal[4][2][chunk]; // force on the corners (0, 0), (1, 0), (0, 1), (1, 1)
  for (std::size_t first = 0; first < grid_.cells_x; first += chunk)
  {
    const std::size_t n = std::min(chunk, grid_.cells_x - first);
    const std::size_t node = row.j * columns + first, cell = row.j * grid_.cells_x + first;
    std::fill(&nodal[0][0][0], &nodal[0][0][0] + 8 * chunk, 0.);
    double energy[chunk] = {};
    double smallest[chunk]; // determinant and stretch
    std::fill(smallest, smallest + chunk, std::numeric_limits<double>::max());
    double power[chunk] = {};
    for (const double s : gauss)
      for (const double t : gauss)
      {
        const auto gradient = [&](const GridVector &field, double(&to)[4][chunk])
        {
          for (unsigned int d = 0; d < 2; ++d)
          {
            const double *low = field[d].data() + node, *high = low + columns;
            for (std::size_t i = 0; i < n; ++i)
            {
              to[2 * d][i] = ((1. - t) * (low[i + 1] - low[i]) + t * (high[i + 1] - high[i])) * rx;
              to[2 * d + 1][i] = ((1. - s) * (high[i] - low[i]) + s * (high[i + 1] - low[i + 1])) * ry;
            }
          }
        };
        gradient(row.u, c.F);
        for (unsigned int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < chunk; ++i)
            c.F[d][i] = (i < n ? c.F[d][i] : 0.) + loading_[d / 2][d % 2];
        if constexpr (is_force)
        {
          gradient(row.v, c.rate);
          std::fill(&c.P[0][0], &c.P[0][0] + 4 * chunk, 0.);
          std::fill(c.power, c.power + chunk, 0.);
          for (const DampedFibre &k : fibres_)
            add_stress(c, k, min_stretch);
          const double x0 = (1. - t) * rx, x1 = t * rx, y0 = (1. - s) * ry, y1 = s * ry;
          for (unsigned int d = 0; d < 2; ++d)
            for (std::size_t i = 0; i < n; ++i)
            {
              const double X = c.P[2 * d][i], Y = c.P[2 * d + 1][i];
              nodal[0][d][i] += x0 * X + y0 * Y;
              nodal[1][d][i] += -x0 * X + y1 * Y;
              nodal[2][d][i] += x1 * X - y0 * Y;
              nodal[3][d][i] += -x1 * X - y1 * Y;
            }
          for (std::size_t i = 0; i < n; ++i)
            power[i] += c.power[i];
        }
        else
        {
          std::fill(c.energy, c.energy + chunk, 0.);
          std::fill(c.shortest, c.shortest + chunk, std::numeric_limits<double>::max());
          for (const DampedFibre &k : fibres_)
            add_energy(c, k, min_stretch);
          for (std::size_t i = 0; i < n; ++i)
          {
            energy[i] += c.energy[i];
            const double J = c.F[0][i] * c.F[3][i] - c.F[1][i] * c.F[2][i];
            smallest[i] = std::min({smallest[i], c.shortest[i] - min_stretch, J});
          }
        }
      }
    for (std::size_t i = 0; i < n; ++i)
    {
      const double g = row.factors[cell + i];
      if constexpr (is_force)
      {
        for (unsigned int d = 0; d < 2; ++d)
        {
          double *low = (*row.force)[d].data() + node + i, *high = low + columns;
          low[0] += weight * g * nodal[0][d][i];
          low[1] += weight * g * nodal[1][d][i];
          high[0] += weight * g * nodal[2][d][i];
          high[1] += weight * g * nodal[3][d][i];
        }
        *row.power += weight * g * power[i];
      }
      else
      {
        (*row.energies)[cell + i] = weight * energy[i];
        if (g > sound_factor && !(smallest[i] > 0.))
          *row.unsound = std::min(*row.unsound, static_cast<double>(cell + i));
      }
    }
  }
}

double FibreForces::forces(const GridVector &u, const GridVector &v, const std::vector<double> &factors,
                           GridVector &force) const
{
  for (std::vector<double> &component : force)
    component.assign(grid_.n_nodes(), 0.);
  std::vector<double> powers(grid_.cells_y, 0.);
  // The rows of cells at the own nodes. Those of one parity share no nodes, and each node adds up its even row first,
  // whatever the number of threads.
  const std::size_t begin = bands_.begin() > 0 ? bands_.begin() - 1 : 0, end = bands_.cells_end();
  for (const std::size_t parity : {0u, 1u})
  {
#pragma omp parallel for schedule(static) if (grid_.n_cells() >= min_cells_for_threads)
    for (std::size_t j = begin + (begin + parity) % 2; j < end; j += 2)
      visit(Row<true>{j, u, v, factors, &force, nullptr, &powers[j], nullptr});
  }
  for (std::vector<double> &component : force)
    bands_.gather_nodes(component);
  bands_.gather_cells(powers);
  double power = 0.;
  for (const double of_row : powers)
    power += of_row;
  return power;
}

void FibreForces::energies(const GridVector &u, const std::vector<double> &factors,
                           std::vector<double> &cell_energies) const
{
  cell_energies.resize(grid_.n_cells());
  const auto none = static_cast<double>(grid_.n_cells());
  std::vector<double> unsound(grid_.cells_y, none);
#pragma omp parallel for schedule(static) if (grid_.n_cells() >= min_cells_for_threads)
  for (std::size_t j = bands_.begin(); j < bands_.cells_end(); ++j)
    visit(Row<false>{j, u, u, factors, nullptr, &cell_energies, nullptr, &unsound[j]});
  bands_.gather_cells(cell_energies);
  bands_.gather_cells(unsound);
  for (const double number : unsound)
    if (number < none)
    {
      const auto cell = static_cast<std::size_t>(number);
      std::ostringstream message;
      message << "a cell that is not broken is inverted, or shorter than " << min_stretch
              << " of its length along a fibre, near X = " << static_cast<double>(cell % grid_.cells_x) * grid_.size_x
              << " m, Y = " << grid_.bottom + static_cast<double>(cell / grid_.cells_x) * grid_.size_y << " m";
      throw NonPhysicalState(message.str());
    }
}

// Largest eigenvalue [1/(m^2) times the unit of D] of the Laplacian with conductivity D = (XX, XY, YY) of one cell
// over the lumped area of its corners.
double FibreForces::largest_eigenvalue(const std::array<double, 3> &conductivity) const
{
  const double rx = 1. / grid_.size_x, ry = 1. / grid_.size_y;
  Eigen::Matrix4d K = Eigen::Matrix4d::Zero();
  for (const double s : gauss)
    for (const double t : gauss)
    {
      const Eigen::Vector4d X(-(1. - t) * rx, (1. - t) * rx, -t * rx, t * rx);
      const Eigen::Vector4d Y(-(1. - s) * ry, -s * ry, (1. - s) * ry, s * ry);
      // Each point has a quarter of the area, as each corner.
      K += conductivity[0] * X * X.transpose() + conductivity[1] * (X * Y.transpose() + Y * X.transpose()) +
           conductivity[2] * Y * Y.transpose();
    }
  return support::symmetric_eigenvalues(K)(3);
}

std::array<double, 3> FibreForces::viscous_conductivity() const
{
  // (n . w)^2 <= |w|^2: the bound does not depend on the deformation.
  std::array<double, 3> D{};
  for (const DampedFibre &k : fibres_)
    D = {D[0] + k.eta * k.X * k.X, D[1] + k.eta * k.X * k.Y, D[2] + k.eta * k.Y * k.Y};
  return D;
}

std::array<double, 3> FibreForces::elastic_conductivity() const
{
  std::array<double, 3> D{};
  for (const DampedFibre &k : fibres_)
  {
    const auto along = [&k](const double l)
    { return k.a * (1. + 2. / (l * l * l)) + 3. * k.b / (l * l * l * l) + k.e; };
    const double l = (loading_ * Tensor<1, 2>({k.X, k.Y})).norm();
    const double across = (k.a * (l - 1. / (l * l)) + k.b * (1. - 1. / (l * l * l)) + k.e * (l - 1.)) / l;
    const double stiffness = std::max(along(std::min(l, relaxed_stretch)), across);
    D = {D[0] + stiffness * k.X * k.X, D[1] + stiffness * k.X * k.Y, D[2] + stiffness * k.Y * k.Y};
  }
  return D;
}

double FibreForces::viscous_rate(const double density) const
{
  return largest_eigenvalue(viscous_conductivity()) / density;
}

double FibreForces::elastic_frequency(const double density) const
{
  return std::sqrt(largest_eigenvalue(elastic_conductivity()) / density);
}
} // namespace latcon::continuum
