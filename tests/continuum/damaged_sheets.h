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

// rho omega^2 of a wave along X_J with polarisation along x_i, at k^2 = K, eqs. (C.47) and (C.82).
inline double stiffness_of_waves(const Tensor<2, 2> &F, const unsigned int J, const unsigned int i, const double K,
                                 const double l_d, const double inertia)
{
  double A_2 = 0., A_4 = 0.;
  for (const BondFamily &bond : lattice())
  {
    const Tensor<1, 2> &N = bond.fibre.direction;
    const Tensor<1, 2> f = F * N;
    const double l = f.norm(), n = f[i] / l;
    const PotentialDerivatives psi = derivatives(bond.fibre.potential, l);
    const double h = bond.fibre.weight * (psi.second * n * n + psi.first / l * (1. - n * n));
    A_2 += h * N[J] * N[J];
    A_4 += h * std::pow(bond.length, 2) * std::pow(N[J], 4) / 12.;
  }
  return (A_2 * K + (l_d * l_d * A_2 - A_4) * K * K) / (1. + inertia * inertia * K);
}

// Multiplies the solution of y' = z y by the factor of one step.
template <class Number>
Number amplification(const ViscousStages &method, const Number z)
{
  Number before = 1., last = 1. + method.first() * z;
  for (const ViscousStages::Stage &c : method.stages())
  {
    const Number next = 1. - c.mu - c.nu + c.mu * last + c.nu * before + z * (c.now * last + c.start);
    before = last;
    last = next;
  }
  return last;
}

} // namespace damaged_sheets
