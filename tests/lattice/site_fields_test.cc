#include "lattice/site_fields.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "lattice/energy.h"
#include "lattice/forces.h"
#include "lattice/relaxation.h"
#include "tests/lattice/sheets.h"

namespace site_fields_test
{

using namespace latcon::lattice;

// Of a site in a sheet that was at rest in the reference configuration and is stretched at once, in motion: sums over
// its bonds. theory.md, eq. (L.31).
TEST(SiteFields, AreSumsOverTheBondsOfASite)
{
  const Eigen::Matrix2d F{{2.1, 0.4}, {-0.3, 1.7}}, rate{{20., -90.}, {30., 50.}};
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
    for (const Material &material : {sheets::rubber(), sheets::disordered_rubber_of_three_shells()})
    {
      const TriangularLattice sheet = sheets::square(12, orientation);
      State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
      relax_memory(state, sheet, material);
      const State stretched = homogeneous_state(sheet, material, F, Edges::held);
      state.position = stretched.position;
      for (const std::size_t place : sheet.sites())
        state.velocity.set(place, rate * sheet.reference(place));
      Forces(sheet, material).evaluate(state, state.velocity, {}, &state.history);
      const std::size_t middle = sheet.index(sheet.rows() / 2, sheet.columns() / 2);
      Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
      double density = 0.;
      for_each_bond_of_site(state, sheet, middle,
                            [&](const Bond &bond)
                            {
                              const Shell &shell = *material.shell(bond.kind);
                              const Eigen::Vector2d R = sheet.bond_vector(bond.kind), n = (F * R).normalized();
                              const double l = R.norm(), stretch = (F * R).norm() / l;
                              double pull = force(shell.law, stretch) + shell.viscosity * n.dot(rate * R) / l;
                              if (const auto *memory = std::get_if<MaxwellMemory>(&shell.memory))
                                for (const MaxwellMemory::Branch &branch : memory->branches())
                                  pull += branch.modulus * (stretch - 1.);
                              const double half = 0.5 * state.stiffness.of(bond.near, bond.kind) *
                                                  cross_section(shell, sheet) / sheet.site_area();
                              stress += half * pull * n * R.transpose();
                              density += half * l * energy(shell.law, stretch);
                            });
      const std::vector<SiteValues> fields = site_fields(state, sheet, material);
      // Sums over up to 18 bonds; positions have the round-off of the sheet's size.
      EXPECT_NEAR(fields[middle].strain_energy_density, density, 1e-13 * density);
      EXPECT_LT((fields[middle].first_piola_stress - stress).norm(), 1e-13 * stress.norm());
      EXPECT_LT((fields[middle].cauchy_stress - stress * F.transpose() / F.determinant()).norm(),
                1e-13 * stress.norm());
      EXPECT_EQ(fields[middle].damage, 0.);
      for (const std::size_t place : sheet.sites())
      {
        EXPECT_LT((fields[place].deformation_gradient - F).norm(), 1e-13);
      }
    }
}

TEST(Relaxation, SaysWhenItDoesNotGetThere)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = sheets::rubber();
  State state = homogeneous_state(sheet, material, sheets::stretched(2.3, 2.8), Edges::held);
  add_noise(state, sheet, 0.1 * sheets::spacing, 3);
  EXPECT_THROW(relax(state, sheet, material, 1e-11, 10), std::runtime_error);
  constrain(state, sheet, {{sheet.index(5, 5)}, true, false});
  EXPECT_THROW(relax(state, sheet, material, 1e-3), std::invalid_argument);
}

constexpr Orientation orientations[] = {Orientation::rows_along_crack, Orientation::rows_across_crack};

// A periodic sheet holds per area of a site one bond of each of nine directions: lengths and directions written out.
// Its sites have no edge: all bonds, no force, the same energy and stress. theory.md, eq. (L.6).
TEST(ThirdShell, HomogeneousSheetHasTheEnergyAndStressOfItsNineDirections)
{
  for (const Orientation orientation : orientations)
  {
    const double d = sheets::spacing, n = 8.;
    const TriangularLattice sheet(d, n * d, n * d, orientation, {true, true});
    const Material material = sheets::rubber_of_three_shells();
    Eigen::Matrix2d F;
    F << 1.4, 0.3, -0.2, 1.7;
    const State state = homogeneous_state(sheet, material, F, Edges::held);
    double energy = 0.;
    Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
    const double first = orientation == Orientation::rows_along_crack ? 0. : 30.; // degrees
    const auto add = [&](const Shell &shell, double length, double degrees)
    {
      const Eigen::Vector2d N(std::cos(degrees * M_PI / 180.), std::sin(degrees * M_PI / 180.));
      const Eigen::Vector2d now = F * N;
      const double weight = shell.area_factor * length; // A0 l / V in units of d
      energy += weight * latcon::lattice::energy(shell.law, now.norm());
      stress += weight * force(shell.law, now.norm()) * now.normalized() * N.transpose();
    };
    for (const double turn : {0., 60., 120.})
    {
      add(material.nearest, 1., first + turn);
      add(*material.next_nearest, std::sqrt(3.), first + turn + 30.);
      add(*material.third_nearest, 2., first + turn);
    }
    const double area = sheet.length() * sheet.height();
    EXPECT_NEAR(elastic_energy(state, sheet, material) / area, energy, 1e-12 * energy);
    Forces forces(sheet, material);
    forces.evaluate(state, state.velocity);
    for (const std::size_t place : sheet.sites())
    {
      const SiteValues values = site_values(state, sheet, material, place);
      EXPECT_EQ(values.bonds, 18u);
      EXPECT_EQ(state.held[place], 0);
      EXPECT_LT((values.deformation_gradient - F).norm(), 1e-12);
      EXPECT_NEAR(values.strain_energy_density, energy, 1e-12 * energy);
      EXPECT_LT((values.first_piola_stress - stress).norm(), 1e-12 * stress.norm());
      // Of 18 forces, each 2.5e5 Pa times a section of about d.
      EXPECT_LT(forces.on_sites().at(place).norm(), 18. * 1e-13 * 2.5e5 * d);
    }
  }
}

} // namespace site_fields_test
