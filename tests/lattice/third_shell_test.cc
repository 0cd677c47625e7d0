// What third-nearest neighbours do; forces_test.cc, ranks/ and others run sheets that have them, too.
#include <cmath>

#include <gtest/gtest.h>

#include "lattice/energy.h"
#include "lattice/site_fields.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/plane_modes.h"
#include "tests/lattice/sheets.h"

namespace lattice_third_shell_test
{

using namespace latcon;

using namespace lattice;

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
      energy += weight * lattice::energy(shell.law, now.norm());
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
    const SiteEvaluator evaluator(sheet, material);
    Forces forces(sheet, material);
    forces.evaluate(state, state.vx, state.vy);
    for (const std::size_t place : sheets::sites(sheet))
    {
      const SiteValues values = evaluator.at(state, place);
      EXPECT_EQ(values.bonds, 18u);
      EXPECT_EQ(state.held[place], 0);
      EXPECT_LT((values.deformation_gradient - F).norm(), 1e-12);
      EXPECT_NEAR(values.strain_energy_density, energy, 1e-12 * energy);
      EXPECT_LT((values.first_piola_stress - stress).norm(), 1e-12 * stress.norm());
      // Of 18 forces, each 2.5e5 Pa times a section of about d.
      EXPECT_LT(std::hypot(forces.fx()[place], forces.fy()[place]), 18. * 1e-13 * 2.5e5 * d);
    }
  }
}

// Forces on a plane wave are -m D u with Bloch's matrix, whose phases are those of bonds up to 2 d long: the largest
// frequency of all waves is that of the sheet, and below the bound of the time step.
TEST(ThirdShell, FrequenciesStayBelowTheBoundOfTheTimeStep)
{
  const Material undamped = sheets::rubber_of_three_shells(0.);
  const TriangularLattice sheet = sheets::square(8);
  const Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  double fastest = 0.;
  for (const std::complex<double> &rate : plane_modes::rates(sheet, undamped, F))
    fastest = support::largest_of({fastest, std::abs(rate.imag())});
  const double limit = time_step_limits(sheet, undamped, 1.).elastic;
  EXPECT_LT(limit, 2. / fastest);
  EXPECT_GT(limit, 0.5 * 2. / fastest); // and not far below
  // What the shell adds to the bound: a bond per direction, of half the inverse length of a nearest one.
  Material without = undamped;
  without.third_nearest.reset();
  const auto square = [&](const Material &material)
  { return std::pow(2. / time_step_limits(sheet, material, 1.).elastic, 2); };
  const Shell &third = *undamped.third_nearest;
  const double added = 3. * 4. * cross_section(third, sheet) * largest_stiffness(third.law, 1.) /
                       (2. * sheets::spacing * site_mass(undamped, sheet));
  EXPECT_NEAR(square(undamped) - square(without), added, 1e-12 * square(undamped));
}

} // namespace lattice_third_shell_test
