#pragma once

// Dashpots, Maxwell branches and problems for tests of dynamics. SI units.

#include "continuum/dynamic_solver.h"
#include "sheets.h"

namespace moving_sheets
{
using namespace sheets;

inline const double density = 944.; // [kg/m^3]
inline const Tensor<2, 2> identity = matrix(1., 0., 0., 1.);

/// Settings of a motion with quadratic elements.
inline latcon::continuum::DynamicSettings quadratic(
  const double time_step,
  const latcon::continuum::NewmarkParameters &rule = latcon::continuum::NewmarkParameters::average_acceleration())
{
  latcon::continuum::DynamicSettings settings{time_step};
  settings.degree = 2;
  settings.rule = rule;
  return settings;
}

inline std::shared_ptr<Field> constant(const double x, const double y)
{
  return std::make_shared<Field>([=](const Point<2> &) { return Tensor<1, 2>({x, y}); });
}

inline latcon::continuum::BoundaryConditions periodic()
{
  latcon::continuum::BoundaryConditions conditions;
  conditions.periodic = {{latcon::continuum::edge::left, latcon::continuum::edge::right, 0},
                         {latcon::continuum::edge::bottom, latcon::continuum::edge::top, 1}};
  return conditions;
}

// Dashpots along the bonds of rubber_network; with a micro-inertia length, also their gradient part, of bonds
// between neighbours at 1/0.6 of that length.
inline latcon::continuum::FibreViscosity network_viscosity(const double eta, const double micro_length = 0.)
{
  std::vector<latcon::continuum::FibreDashpot> dashpots;
  for (const auto &bond : rubber_bonds(micro_length / 0.6))
    dashpots.push_back({bond.fibre.direction, bond.fibre.weight, eta, bond.length});
  return latcon::continuum::FibreViscosity(dashpots, micro_length);
}

// Maxwell branches of equal moduli along the bonds of rubber_network; a micro-inertia length as for network_viscosity.
inline latcon::continuum::FibreMemory network_memory(const double modulus, const std::vector<double> &relaxation_times,
                                                     const double micro_length = 0.)
{
  std::vector<latcon::continuum::MaxwellFibres> families;
  for (const auto &bond : rubber_bonds(micro_length / 0.6))
  {
    families.push_back({bond.fibre.direction, bond.fibre.weight, {}, 0, bond.length});
    for (const double time : relaxation_times)
      families.back().branches.push_back({modulus, time});
  }
  return latcon::continuum::FibreMemory(families, micro_length);
}

// Problem with all features: a moving held edge, a traction, a weak normal gradient, a gradient law, viscosity
// with a gradient part.
struct Problem
{
  latcon::continuum::CauchyBorn law = rubber_network();
  latcon::continuum::IsotropicGradient gradient{5e5, 0.02};
  latcon::continuum::FibreViscosity viscosity = network_viscosity(20., 0.01);

  latcon::continuum::BoundaryConditions conditions() const
  {
    latcon::continuum::BoundaryConditions all({{latcon::continuum::edge::left, affine(matrix(1., 0., 0.3, 1.2))}});
    all.tractions = {{latcon::continuum::edge::top, constant(0., 1e5)}};
    all.normal_gradients = {{latcon::continuum::edge::right, constant(0.2, 0.1)}};
    return all;
  }
  // Two derivatives vanish at the start; the period is 10 ms, that of the slowest mode about 25 ms.
  static double load_factor(const double time) { return std::pow(std::sin(100. * pi * time), 4); }
};

} // namespace moving_sheets
