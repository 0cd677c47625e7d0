// Laws and motions are invariant under a change of units: bits do not change for units that are powers of two.
#include "moving_sheets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace units_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::GradientLaw;
using continuum::Order;
using Gradient = GradientLaw::Gradient;

constexpr double spacing = 0.625e-3;

// Lengths 4 times and stresses 8 times larger: factors 1/4 for gradients, 32 for double stresses, 128 for gradient
// stiffnesses.
TEST(GradientLaw, DoesNotDependOnUnits)
{
  constexpr double l = 4., e = 8.;
  const continuum::CauchyBorn own_network = rubber_network(), network = rubber_network(e * 1e5, e * 1.5e5);
  const continuum::LatticeGradient own_lattice = rubber_gradient(spacing);
  const continuum::IsotropicGradient own_isotropic(5e5, 0.4 * spacing);
  std::vector<continuum::BondFamily> bonds = rubber_bonds(l * spacing);
  for (std::size_t k = 0; k < bonds.size(); ++k)
    bonds[k].fibre = network.families()[k];
  const continuum::LatticeGradient lattice(bonds, continuum::LatticeGradient::smallest_length(bonds));
  const continuum::IsotropicGradient isotropic(e * 5e5, l * 0.4 * spacing);
  const std::vector<const GradientLaw *> own{&own_lattice, &own_isotropic}, others{&lattice, &isotropic};
  std::mt19937 generator(5);
  for (std::size_t n = 0; n < others.size(); ++n)
    for (int sample = 0; sample < 20; ++sample)
    {
      const GradientLaw &law = *own[n], &other = *others[n];
      const Tensor<2, 2> F = random_deformation(generator, 1.1, 3.);
      const Gradient G = random_gradient(generator, spacing);
      EXPECT_EQ(other.energy(F, G / l), e * law.energy(F, G));
      const auto there = other.evaluate(F, G / l, Order::second), here = law.evaluate(F, G, Order::second);
      EXPECT_EQ(other.first_piola_stress(F, G / l), e * law.first_piola_stress(F, G));
      EXPECT_EQ(there.tangent, e * here.tangent);
      EXPECT_EQ(other.double_stress(F, G / l), e * l * law.double_stress(F, G));
      EXPECT_EQ(there.double_stress_by_F, e * l * here.double_stress_by_F);
      EXPECT_EQ(there.double_stress_by_G, e * l * l * here.double_stress_by_G);
      EXPECT_EQ(other.normal_stiffness(), e * l * l * law.normal_stiffness());
      EXPECT_EQ(network.energy(F), e * own_network.energy(F));
      EXPECT_EQ(network.first_piola_stress(F), e * own_network.first_piola_stress(F));
      EXPECT_EQ(network.tangent(F), e * own_network.tangent(F));
    }
}

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
