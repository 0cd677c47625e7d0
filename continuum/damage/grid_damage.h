#pragma once

#include "continuum/damage/damage_law.h"
#include "continuum/rectangle.h"

#include <cstddef>
#include <vector>

namespace latcon::continuum
{
/// Uniform grid of a Rectangle. Node (i, j), i = 0 ... cells_x, j = 0 ... cells_y, has the index j (cells_x + 1) + i;
/// cell (i, j) lies between the nodes (i, j) and (i + 1, j + 1) and has the index j cells_x + i.
struct NodeGrid
{
  std::size_t cells_x, cells_y;
  double size_x, size_y; ///< of a cell [m]
  double bottom;         ///< smallest Y [m]; the smallest X is 0

  /// Creates the grid. Throws InvalidInput for sizes that are not positive and finite, no cells, and periodic edges.
  explicit NodeGrid(const Rectangle &rectangle);

  std::size_t columns() const { return cells_x + 1; } ///< of nodes
  std::size_t rows() const { return cells_y + 1; }    ///< of nodes
  std::size_t n_nodes() const { return columns() * rows(); }
  std::size_t n_cells() const { return cells_x * cells_y; }
  double area() const { return size_x * size_y; } ///< of a cell [m^2]
  /// Returns the reference position of a node [m].
  dealii::Point<2> position(std::size_t node) const
  {
    return {static_cast<double>(node % columns()) * size_x, bottom + static_cast<double>(node / columns()) * size_y};
  }
};

/// Damage phi at the nodes of a grid for a sheet in motion: minimises
///   sum over cells c of g_c E_c + S(phi),   g_c = mean of g(phi_a) over the nodes a of c,
/// over phi not below its last values (theory-damage.md, eqs. (C.69), (C.70)). The factor g_c of a cell multiplies its
/// energy, its stress and its mass alike. Serial and deterministic.
class GridDamage
{
public:
  /// Creates a field without damage. `intact` marks nodes whose damage minimize() does not change; empty: none. Throws
  /// InvalidInput for constants out of range and for cells with sides in a ratio above sqrt(2), on which phi could
  /// exceed 1.
  GridDamage(const NodeGrid &grid, const DamageLaw &law, std::vector<char> intact = {});

  /// Sets the nodal damage [-]. Throws InvalidInput for values out of [0, 1].
  void set(const std::vector<double> &damage);

  /// Minimises over phi, at given energies [J/m] >= 0 of the undegraded cells, E_c, and nodes, which have the factor
  /// g(phi_a); empty: no energy of nodes. Returns true if any node changed. Only the neighbourhood of nodes that are
  /// driven is visited. Throws NonPhysicalState if an energy is not finite and LinearSolverFailed if the iteration does
  /// not converge.
  bool minimize(const std::vector<double> &cell_energies, const std::vector<double> &node_energies = {});

  /// Returns S(phi) [J/m], eq. (C.61).
  double fracture_energy() const;

  const DamageLaw &law() const { return law_; }
  const std::vector<double> &nodal() const { return damage_; }              ///< phi_a [-]
  const std::vector<double> &cell_factors() const { return factor_; }       ///< g_c [-]
  const std::vector<double> &node_factors() const { return nodal_factor_; } ///< g(phi_a) [-]

  /// Change of phi in the last sweep over the nodes at which minimize() stops [-].
  static constexpr double tolerance = 1e-7;

private:
  struct Window
  {
    std::size_t i0, i1, j0, j1; // first and last node
  };
  double laplacian(std::size_t i, std::size_t j) const;
  unsigned int cells_at(std::size_t i, std::size_t j) const;
  double sweep(const Window &window, bool forward);
  void update_factors();

  NodeGrid grid_;
  DamageLaw law_;
  std::vector<char> intact_;
  std::vector<double> damage_, lower_bound_, factor_, nodal_factor_;
  std::vector<double> drive_;                    // e_a [J/m]
  double diagonal_, along_x_, along_y_, across_; // of the Laplacian of one cell [-]
};
} // namespace latcon::continuum
