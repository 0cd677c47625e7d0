#include "continuum/damage/grid_damage.h"

#include "continuum/errors.h"

#include <algorithm>
#include <cmath>

namespace latcon::continuum
{
NodeGrid::NodeGrid(const Rectangle &rectangle)
  : cells_x(rectangle.cells_x), cells_y(rectangle.cells_y), size_x(rectangle.length / rectangle.cells_x),
    size_y(rectangle.height / rectangle.cells_y), bottom(-0.5 * rectangle.height)
{
  if (cells_x == 0 || cells_y == 0 || !(size_x > 0. && std::isfinite(size_x) && size_y > 0. && std::isfinite(size_y)))
    throw InvalidInput("a grid needs cells, and positive and finite sizes");
  if (rectangle.periodic_x || rectangle.periodic_y)
    throw InvalidInput("a grid in motion with damage does not support periodic edges");
}

GridDamage::GridDamage(const NodeGrid &grid, const DamageLaw &law, std::vector<char> intact)
  : grid_(grid), law_(law), intact_(std::move(intact)), damage_(grid.n_nodes(), 0.), lower_bound_(grid.n_nodes(), 0.),
    factor_(grid.n_cells(), 1.), drive_(grid.n_nodes(), 0.)
{
  const auto require = [](const bool holds, const char *rule)
  {
    if (!holds)
      throw InvalidInput(rule);
  };
  require(law.threshold > 0. && std::isfinite(law.threshold), "the threshold of damage must be positive and finite");
  require(law.length > 0. && std::isfinite(law.length), "the length of damage must be positive and finite");
  require(law.residual_stiffness > 0. && law.residual_stiffness < 1., "the residual stiffness must be in (0, 1)");
  const double ratio = grid.size_y / grid.size_x;
  require(ratio * ratio <= 2. && ratio * ratio >= 0.5, "cells with damage must not be longer than sqrt(2) of their "
                                                       "width");
  if (intact_.empty())
    intact_.assign(grid.n_nodes(), 0);
  require(intact_.size() == grid.n_nodes(), "the marks of intact nodes belong to another grid");
  diagonal_ = (ratio + 1. / ratio) / 3.;
  along_x_ = (-2. * ratio + 1. / ratio) / 6.;
  along_y_ = (ratio - 2. / ratio) / 6.;
  across_ = -(ratio + 1. / ratio) / 6.;
  update_factors();
}

void GridDamage::set(const std::vector<double> &damage)
{
  if (damage.size() != damage_.size())
    throw InvalidInput("the damage belongs to another grid");
  for (const double d : damage)
    if (!(d >= 0. && d <= 1.))
      throw InvalidInput("damage must be in [0, 1]");
  damage_ = lower_bound_ = damage;
  update_factors();
}

unsigned int GridDamage::cells_at(const std::size_t i, const std::size_t j) const
{
  return ((i > 0 ? 1u : 0u) + (i < grid_.cells_x ? 1u : 0u)) * ((j > 0 ? 1u : 0u) + (j < grid_.cells_y ? 1u : 0u));
}

// Sum over b of the integral of Grad phi_a . Grad phi_b times d_b, a = (i, j).
double GridDamage::laplacian(const std::size_t i, const std::size_t j) const
{
  const double *d = damage_.data() + j * grid_.columns() + i;
  const auto pitch = static_cast<std::ptrdiff_t>(grid_.columns());
  double sum = 0.;
  for (const std::ptrdiff_t x : {-1, 1})
    for (const std::ptrdiff_t y : {-1, 1})
      if ((x < 0 ? i > 0 : i < grid_.cells_x) && (y < 0 ? j > 0 : j < grid_.cells_y))
        sum += diagonal_ * d[0] + along_x_ * d[x] + along_y_ * d[y * pitch] + across_ * d[x + y * pitch];
  return sum;
}

// Relaxes the nodes of a window in turn. Returns the largest change of d.
double GridDamage::sweep(const Window &window, const bool forward)
{
  // Over-relaxation: converges for every factor in (0, 2); this one suits two to four cells per length.
  constexpr double relaxation = 1.5;
  const double stiffness = 2. * law_.threshold * law_.length * law_.length;
  double largest = 0.;
  const auto visit = [&](const std::size_t i, const std::size_t j)
  {
    const std::size_t a = j * grid_.columns() + i;
    if (intact_[a])
      return;
    const unsigned int n = cells_at(i, j);
    const double descent =
      drive_[a] * (1. - damage_[a]) - law_.threshold * 0.25 * n * grid_.area() - stiffness * laplacian(i, j);
    const double next =
      std::clamp(damage_[a] + relaxation * descent / (drive_[a] + stiffness * n * diagonal_), lower_bound_[a], 1.);
    largest = std::max(largest, std::abs(next - damage_[a]));
    damage_[a] = next;
  };
  if (forward)
    for (std::size_t j = window.j0; j <= window.j1; ++j)
      for (std::size_t i = window.i0; i <= window.i1; ++i)
        visit(i, j);
  else
    for (std::size_t j = window.j1 + 1; j-- > window.j0;)
      for (std::size_t i = window.i1 + 1; i-- > window.i0;)
        visit(i, j);
  return largest;
}

bool GridDamage::minimize(const std::vector<double> &cell_energies, const std::vector<double> &node_energies)
{
  const std::size_t columns = grid_.columns();
  if (cell_energies.size() != grid_.n_cells())
    throw InvalidInput("the energies of cells belong to another grid");
  std::fill(drive_.begin(), drive_.end(), 0.);
  for (std::size_t j = 0; j < grid_.cells_y; ++j)
    for (std::size_t i = 0; i < grid_.cells_x; ++i)
    {
      const double share = 0.25 * cell_energies[j * grid_.cells_x + i];
      if (!std::isfinite(share))
        throw NonPhysicalState("the stored energy of a cell is not finite");
      const std::size_t a = j * columns + i;
      for (const std::size_t b : {a, a + 1, a + columns, a + columns + 1})
        drive_[b] += share;
    }
  if (!node_energies.empty() && node_energies.size() != grid_.n_nodes())
    throw InvalidInput("the energies of nodes belong to another grid");
  for (std::size_t a = 0; a < node_energies.size(); ++a)
  {
    if (!std::isfinite(node_energies[a]))
      throw NonPhysicalState("the gradient energy of a node is not finite");
    drive_[a] += node_energies[a];
  }
  lower_bound_ = damage_;

  const double stiffness = 2. * law_.threshold * law_.length * law_.length;
  constexpr unsigned int max_sweeps = 20000;
  bool has_changed = false;
  for (unsigned int n = 0; n < max_sweeps;)
  {
    // Window of the nodes at which the energy still falls with phi, and their neighbours.
    Window window{columns, 0, grid_.rows(), 0};
    for (std::size_t j = 0; j < grid_.rows(); ++j)
      for (std::size_t i = 0; i < columns; ++i)
      {
        const std::size_t a = j * columns + i;
        const unsigned int n_cells = cells_at(i, j);
        // Without damage around it, a node is undriven below the threshold.
        const double driven = drive_[a] * (1. - damage_[a]) - law_.threshold * 0.25 * n_cells * grid_.area();
        if (intact_[a] || damage_[a] >= 1.)
          continue;
        const double descent = driven - stiffness * laplacian(i, j);
        const double diagonal = drive_[a] + stiffness * n_cells * diagonal_;
        if (descent > tolerance * diagonal || (damage_[a] > lower_bound_[a] && -descent > tolerance * diagonal))
          window = {std::min(window.i0, i), std::max(window.i1, i), std::min(window.j0, j), std::max(window.j1, j)};
      }
    if (window.i0 > window.i1)
    {
      if (has_changed)
        update_factors();
      return has_changed;
    }
    has_changed = true;
    window = {window.i0 - (window.i0 > 0), std::min(window.i1 + 1, grid_.cells_x), window.j0 - (window.j0 > 0),
              std::min(window.j1 + 1, grid_.cells_y)};
    double change = 0.;
    do
      change = sweep(window, n++ % 2 == 0);
    while (change > tolerance && n < max_sweeps);
  }
  throw LinearSolverFailed("the damage of a grid did not converge");
}

void GridDamage::update_factors()
{
  const std::size_t columns = grid_.columns();
  nodal_factor_.resize(damage_.size());
  std::vector<double> &g = nodal_factor_;
  for (std::size_t a = 0; a < g.size(); ++a)
    g[a] = law_.degradation(damage_[a]);
  for (std::size_t j = 0; j < grid_.cells_y; ++j)
    for (std::size_t i = 0; i < grid_.cells_x; ++i)
    {
      const std::size_t a = j * columns + i;
      factor_[j * grid_.cells_x + i] = 0.25 * (g[a] + g[a + 1] + g[a + columns] + g[a + columns + 1]);
    }
}

double GridDamage::fracture_energy() const
{
  double sum = 0.;
  for (std::size_t j = 0; j < grid_.rows(); ++j)
    for (std::size_t i = 0; i < grid_.columns(); ++i)
    {
      const double d = damage_[j * grid_.columns() + i];
      sum += 0.25 * cells_at(i, j) * grid_.area() * d + law_.length * law_.length * d * laplacian(i, j);
    }
  return 2. * (1. - law_.residual_stiffness) * law_.threshold * sum;
}
} // namespace latcon::continuum
