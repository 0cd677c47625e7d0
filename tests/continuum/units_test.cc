// Motions are invariant under a change of units: bits do not change for units that are powers of two.
#include "moving_sheets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace units_test
{

using namespace latcon;
using namespace moving_sheets;

// Units of a sheet relative to those of another one. The equation of motion, r u / t^2 = e / l, determines the unit of
// time; a viscosity is a stress times a time.
struct Units
{
  double length, stress, density;
  double time() const { return length * std::sqrt(density / stress); }
};

// Sheet with all quantities that have units: mass with micro-inertia, both laws, dashpots, a moving edge, a traction, a
// weak normal gradient.
struct MovingSheet
{
  explicit MovingSheet(const Units &units)
    : network(rubber_network(units.stress * 1e5, units.stress * 1.5e5)), gradient(bonds(units), l_d(units)),
      viscosity(network_viscosity(units.stress * units.time() * 20.)), mesh(MPI_COMM_SELF)
  {
    continuum::make_rectangle(mesh, {units.length * length, units.length * height, 2, 2});
    continuum::BoundaryConditions conditions({{continuum::edge::left, affine(matrix(1., 0., 0.3, 1.2))}});
    conditions.tractions = {{continuum::edge::top, constant(0., units.stress * 1e5)}};
    conditions.normal_gradients = {{continuum::edge::right, constant(0.2, 0.1)}};
    const double t = units.time();
    const continuum::DynamicSettings settings =
      quadratic(t * 2e-4, continuum::NewmarkParameters::generalised_alpha(0.6));
    solver = std::make_unique<continuum::DynamicSolver>(
      mesh, continuum::Constitution(network, gradient), conditions,
      continuum::Inertia{units.density * density, l_d(units)}, settings, &viscosity,
      [t](const double time) { return std::pow(std::sin(100. * pi * time / t), 4); });
    solver->start();
    for (unsigned int n = 0; n < 20; ++n)
      solver->step();
  }

  std::vector<continuum::BondFamily> bonds(const Units &units) const
  {
    auto all = rubber_bonds(units.length * 0.02);
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k].fibre = network.families()[k];
    return all;
  }
  double l_d(const Units &units) const { return continuum::LatticeGradient::smallest_length(bonds(units)); }

  continuum::CauchyBorn network;
  continuum::LatticeGradient gradient;
  continuum::FibreViscosity viscosity;
  Mesh mesh;
  std::unique_ptr<continuum::DynamicSolver> solver;
};

// All units are powers of two, so both runs have equal mantissas everywhere: in the elements, in the factors of the
// matrix and in all compared norms.
TEST(DynamicSolver, DoesNotDependOnUnits)
{
  const MovingSheet one_sheet({1., 1., 1.});
  const auto &one = one_sheet.solver;
  EXPECT_GT(one->displacement().linfty_norm(), 0.01 * length);
  EXPECT_NE(one->ledger().dissipated, 0.);
  for (const Units &units : {Units{4., 1., 1.}, Units{1., 4., 16.}, Units{0.5, 16., 4.}})
  {
    const MovingSheet other_sheet(units);
    const auto &other = other_sheet.solver;
    const double l = units.length, per_energy = 1. / (units.stress * l * l);
    for (const auto i : one->displacement().locally_owned_elements())
    {
      ASSERT_EQ(other->displacement()(i), l * one->displacement()(i));
      ASSERT_EQ(other->velocity()(i), l / units.time() * one->velocity()(i));
    }
    EXPECT_EQ(per_energy * other->ledger().stored, one->ledger().stored);
    EXPECT_EQ(per_energy * other->ledger().kinetic, one->ledger().kinetic);
    EXPECT_EQ(per_energy * other->ledger().micro_kinetic, one->ledger().micro_kinetic);
    EXPECT_EQ(per_energy * other->ledger().dissipated, one->ledger().dissipated);
    EXPECT_EQ(per_energy * other->ledger().work, one->ledger().work);
  }
}

} // namespace units_test
