#include "lattice/site_fields.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/relaxation.h"
#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

namespace site_fields_test
{

using namespace latcon;

using namespace lattice;

// Uniaxial stretch of a lattice of linear bonds, nearest neighbours alone: the sums over 0, 60, 120 degrees by hand.
TEST(SiteFields, AreTheHandSumsOfAHomogeneousStretch)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material{944., {LinearBond{2e5}, 0.5, 10.}, std::nullopt};
  const State state = homogeneous_state(sheet, material, sheets::stretched(1.2, 1.), Edges::held);
  const SiteFields fields = site_fields(state, sheet, material);
  const std::size_t middle = sheet.index(sheet.rows() / 2, 5);
  // A0 l / V = s for nearest neighbours. Stretches: 1.2 along the row, l = sqrt(0.6^2 + 3/4) at +-60 degrees.
  const double l = std::sqrt(0.36 + 0.75);
  const double energy = 0.5 * 0.5 * 2e5 * (0.04 + 2. * (l - 1.) * (l - 1.));
  EXPECT_NEAR(fields.strain_energy_density[middle], energy, 1e-10 * energy);
  const double pxx = 0.5 * 2e5 * (0.2 + 2. * (l - 1.) * (0.6 / l) * 0.5);
  const double pyy = 0.5 * 2e5 * 2. * (l - 1.) * 0.75 / l;
  const Eigen::Matrix2d P = fields.first_piola_stress[middle];
  EXPECT_NEAR(P(0, 0), pxx, 1e-10 * pxx);
  EXPECT_NEAR(P(1, 1), pyy, 1e-10 * pxx);
  EXPECT_NEAR(P(0, 1), 0., 1e-10 * pxx);
  EXPECT_NEAR(fields.deformation_gradient[middle](0, 0), 1.2, 1e-12);
  EXPECT_NEAR(fields.deformation_gradient[middle](1, 1), 1., 1e-12);
  EXPECT_NEAR(fields.cauchy_stress[middle](0, 0), pxx, 1e-9 * pxx);       // P F^T / J = pxx 1.2 / 1.2
  EXPECT_NEAR(fields.cauchy_stress[middle](1, 1), pyy / 1.2, 1e-9 * pxx); // pyy 1 / 1.2
  EXPECT_EQ(fields.damage[middle], 0.);
}

TEST(SiteFields, DeformationGradientIsThatOfAnyHomogeneousState)
{
  const TriangularLattice sheet = sheets::square(12, Orientation::rows_across_crack);
  const Material material = sheets::rubber();
  Eigen::Matrix2d F;
  F << 2.1, 0.4, -0.3, 1.7;
  const SiteFields fields = site_fields(homogeneous_state(sheet, material, F, Edges::free), sheet, material);
  for (const std::size_t place : sheets::sites(sheet))
  {
    // Round-off of positions, 1e-16 of the sheet's size, over d.
    EXPECT_NEAR((fields.deformation_gradient[place] - F).norm(), 0., 1e-13);
  }
}

// A sheet at rest in the reference configuration that is stretched at once. theory.md, eq. (L.31), at the start:
// P = P_law + sum A0 l / V E (lam - 1) n N.
TEST(BondMemoryStress, IsThatOfTheOverstress)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber_with_memory();
  const Eigen::Matrix2d F = sheets::stretched(1.4, 1.3);
  State at_rest = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  relax_memory(at_rest, sheet, material);
  State stretched = homogeneous_state(sheet, material, F, Edges::held);
  stretched.history = at_rest.history;
  const Simulation simulation(sheet, material, std::move(stretched), 2e-7);
  State without = simulation.state();
  without.history = {};

  const std::size_t middle = sheet.index(sheet.rows() / 2, sheet.columns() / 2);
  Eigen::Matrix2d overstress = Eigen::Matrix2d::Zero();
  for (std::size_t kind = 0; kind < 2 * n_kinds_per_shell; ++kind)
  {
    const Eigen::Vector2d R = sheet.bond_vector(kind), r = F * R;
    const double modulus = TriangularLattice::is_nearest(kind) ? 3e5 : 1.5e5; // as in rubber_with_memory()
    overstress += cross_section(*material.shell(kind), sheet) / sheet.site_area() * modulus *
                  (r.norm() / R.norm() - 1.) * r.normalized() * R.transpose();
  }
  const SiteEvaluator evaluator(sheet, material);
  const Eigen::Matrix2d found =
    evaluator.at(simulation.state(), middle).first_piola_stress - evaluator.at(without, middle).first_piola_stress;
  // Sums over twelve bonds, the stress of the laws being several times that of the memories.
  EXPECT_LT((found - overstress).norm(), 1e-13 * overstress.norm());
}

// A held sheet shaken by noise relaxes to the homogeneous state: the only equilibrium near it.
TEST(Relaxation, NoiseRelaxesToTheHomogeneousState)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = sheets::rubber();
  const State homogeneous = homogeneous_state(sheet, material, sheets::stretched(2.3, 2.8), Edges::held);
  State state = homogeneous;
  add_noise(state, sheet, 0.1 * sheets::spacing, 3);
  // Forces of single bonds are of the order A0 psi' = 2e2 N/m; round-off of sums of twelve, 1e-13.
  const Relaxation relaxation = relax(state, sheet, material, 1e-11);
  EXPECT_LE(relaxation.residual, 1e-11);
  EXPECT_GT(relaxation.iterations, 10u);
  // Residual over the stiffness of the softest mode, that of the longest wave: A0 psi'' / d (pi d / L)^2, 2e4 N/m^2
  // here, coherent over the 400 sites at worst.
  const double displacement_error = 400. * 1e-11 / 2e4;
  for (std::size_t i = 0; i < state.x.size(); ++i)
  {
    EXPECT_NEAR(state.x[i], homogeneous.x[i], displacement_error);
    EXPECT_EQ(state.vx[i], 0.);
  }
}

TEST(Relaxation, SaysWhenItDoesNotGetThere)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = sheets::rubber();
  State state = homogeneous_state(sheet, material, sheets::stretched(2.3, 2.8), Edges::held);
  add_noise(state, sheet, 0.1 * sheets::spacing, 3);
  EXPECT_THROW(relax(state, sheet, material, 1e-11, 10), std::runtime_error);
}

} // namespace site_fields_test
