#pragma once

// Fibres, bonds and fields of sheets with damage on a grid. SI units.

#include "continuum/damage/damage_motion.h"
#include "sheets.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace damaged_sheets
{
using namespace sheets;
using namespace latcon::continuum;

inline constexpr double spacing = 1.; // of the bonds [m]

inline std::vector<FibreFamily> springs()
{
  std::vector<FibreFamily> fibres;
  for (const double angle : {0., pi / 3., 2. * pi / 3.})
    fibres.push_back({Tensor<1, 2>({std::cos(angle), std::sin(angle)}), 1., LinearPotential{1e6}});
  return fibres;
}

inline std::vector<FibreFamily> rods()
{
  std::vector<FibreFamily> fibres = springs();
  for (FibreFamily &fibre : fibres)
    fibre.potential = RodPotential{1e5, 1.5e5};
  return fibres;
}

// Dashpots along fibres.
inline std::vector<FibreDashpot> dashpots(const std::vector<FibreFamily> &fibres, const double viscosity)
{
  std::vector<FibreDashpot> all;
  for (const FibreFamily &fibre : fibres)
    all.push_back({fibre.direction, fibre.weight, viscosity});
  return all;
}

// Triangular lattice with both shells, of rubber.
inline std::vector<BondFamily> lattice()
{
  std::vector<BondFamily> bonds;
  for (unsigned int k = 0; k < 6; ++k)
  {
    const Tensor<1, 2> N({std::cos(pi * k / 6.), std::sin(pi * k / 6.)});
    bonds.push_back(
      {{N, k % 2 == 0 ? 0.7 : 1.4, RodPotential{1e5, 1.5e5}}, (k % 2 == 0 ? 1. : std::sqrt(3.)) * spacing});
  }
  return bonds;
}

inline std::vector<FibreFamily> fibres(const std::vector<BondFamily> &bonds)
{
  std::vector<FibreFamily> all;
  for (const BondFamily &bond : bonds)
    all.push_back(bond.fibre);
  return all;
}

inline GridVector nodal(const NodeGrid &grid, const std::function<Tensor<1, 2>(const Point<2> &)> &field)
{
  GridVector u;
  for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    for (const unsigned int i : {0u, 1u})
      u[i].push_back(field(grid.position(a))[i]);
  return u;
}

inline GridVector random_field(const NodeGrid &grid, const double amplitude)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(-amplitude, amplitude);
  return nodal(grid,
               [&](const Point<2> &)
               {
                 const double x = some(random);
                 return Tensor<1, 2>({x, some(random)});
               });
}

} // namespace damaged_sheets
