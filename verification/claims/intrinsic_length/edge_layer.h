#pragma once

#include <vector>

#include "lattice/material.h"

namespace latcon::claims
{

/// Spacings of the rows of a sheet that ends in a free row, stretched along its rows and free across them.
struct EdgeLayer
{
  double stretch_across;          ///< of the bulk [-]
  std::vector<double> deviations; ///< of the spacing of rows j and j + 1 from the bulk's, over it, from the edge [-]
  double residual;                ///< largest force left on a site [N/m]
};

/// Relaxes a strip, periodic along its rows, and measures its upper edge.
/// @param stretch along the rows [-]
/// @param rows number of row spacings to measure; the strip has four times as many rows
/// @throws std::runtime_error if the lattice does not relax
EdgeLayer relaxed_edge(double spacing, const lattice::Material &material, double stretch, std::size_t rows);

/// Factor from one row spacing to the next by which a small deviation decays, from the linearised equilibrium of rows
/// (theory-comparison.md, eq. (W.6)): negative, the spacings alternate; 0 where nearest neighbours are alone.
/// @param stretch,stretch_across of the bulk [-]
double edge_decay(double spacing, const lattice::Material &material, double stretch, double stretch_across);

} // namespace latcon::claims
