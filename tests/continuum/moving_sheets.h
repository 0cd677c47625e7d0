#pragma once

// Dashpots, Maxwell branches and problems for tests of dynamics. SI units.

#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "sheets.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/vector_tools.h>

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

/// Starts a motion with the nodal values of fields; none: zero.
inline void start(latcon::continuum::DynamicSolver &solver, const std::shared_ptr<Field> &displacement = nullptr,
                  const std::shared_ptr<Field> &velocity = nullptr)
{
  const latcon::continuum::Sheet &sheet = solver.sheet();
  dealii::AffineConstraints<double> hanging(sheet.relevant()); // without periodicity: a field may be affine
  dealii::DoFTools::make_hanging_node_constraints(sheet.dof_handler(), hanging);
  hanging.close();
  const auto at_nodes = [&](const std::shared_ptr<Field> &field)
  {
    latcon::continuum::Sheet::Vector x = sheet.make_owned();
    if (field)
      dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), *field, x);
    hanging.distribute(x);
    return x;
  };
  solver.start(at_nodes(displacement), at_nodes(velocity));
}

/// Advances by whole steps until the time is at least `end` [s].
template <class Observer>
void run_until(latcon::continuum::DynamicSolver &solver, const double end, const Observer &observer)
{
  while (solver.time() < (1. - 1e-9) * end)
  {
    solver.step();
    observer();
  }
}
inline void run_until(latcon::continuum::DynamicSolver &solver, const double end)
{
  run_until(solver, end, [] {});
}

/// Momentum of a sheet of the density [kg/s] per unit reference thickness.
inline Tensor<1, 2> momentum(const latcon::continuum::DynamicSolver &solver)
{
  const latcon::continuum::Sheet &sheet = solver.sheet();
  Tensor<1, 2> sum;
  for (unsigned int i = 0; i < 2; ++i)
    sum[i] = density * dealii::GridTools::volume(sheet.mesh(), sheet.mapping()) *
             dealii::VectorTools::compute_mean_value(sheet.mapping(), sheet.dof_handler(),
                                                     dealii::QGauss<2>(sheet.degree() + 1), solver.velocity(), i);
  return sum;
}

/// The rubber network, which refuses a number of evaluations.
struct RefusingNetwork : latcon::continuum::CauchyBorn
{
  RefusingNetwork() : CauchyBorn(rubber_network()) {}
  latcon::continuum::Response evaluate(const Tensor<2, 2> &F, latcon::continuum::Order order) const override
  {
    if (refusals == 0)
      return CauchyBorn::evaluate(F, order);
    --refusals;
    throw latcon::continuum::NonPhysicalState("det F is refused");
  }
  mutable unsigned int refusals = 0;
};

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

// Problem with all features: a held edge, a traction, a weak normal gradient, a gradient law, viscosity with a gradient
// part.
struct Problem
{
  latcon::continuum::CauchyBorn law = rubber_network();
  latcon::continuum::IsotropicGradient gradient{5e5, 0.02};
  latcon::continuum::FibreViscosity viscosity = network_viscosity(20., 0.01);

  latcon::continuum::BoundaryConditions conditions() const
  {
    latcon::continuum::BoundaryConditions all = held();
    all.tractions = {{latcon::continuum::edge::top, constant(0., 1e5)}};
    all.normal_gradients = {{latcon::continuum::edge::right, constant(0.2, 0.1)}};
    return all;
  }
  latcon::continuum::BoundaryConditions held() const { return {{latcon::continuum::edge::left, constant(0., 0.)}}; }
  // Smooth, so that a motion from rest hardly excites fast modes.
  static std::shared_ptr<Field> velocity()
  {
    return std::make_shared<Field>([](const Point<2> &X) { return Tensor<1, 2>({20. * X[0], 50. * X[0]}); });
  }
};

} // namespace moving_sheets
