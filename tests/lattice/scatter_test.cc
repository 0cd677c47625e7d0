// Scattered points and the weights of their bonds. Energies and waves: tests/verification/claims/nonlocal_test.cc.
#include "lattice/scatter.h"

#include <gtest/gtest.h>

#include "lattice/fracture.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/nonlocal_sheets.h"

namespace lattice_scatter_test
{

using namespace latcon::lattice;

constexpr double d = sheets::spacing;

TriangularLattice sheet(double length, double scatter = 0.5, double m = 1.5)
{
  return nonlocal_sheets::sheet(Grid::Kind::square, m, length, 16., 30., Orientation::rows_along_crack, scatter);
}

TEST(Scatter, MovesEachPointWhateverTheOthersAre)
{
  const TriangularLattice narrow = sheet(16.), wide = sheet(24.), grid = sheet(16., 0.);
  const double h = grid.spacing();
  Eigen::Array2d largest(0., 0.), smallest = largest;
  for (std::size_t row = 0; row < grid.rows(); ++row)
    for (std::size_t column = 0; column < grid.columns(); ++column)
    {
      const Eigen::Vector2d X = narrow.reference(narrow.index(row, column));
      EXPECT_EQ(X, wide.reference(wide.index(row, column)));
      const Eigen::Array2d moved = (X - grid.reference(grid.index(row, column))) / h;
      largest = largest.max(moved);
      smallest = smallest.min(moved);
    }
  EXPECT_LE(largest.maxCoeff(), 0.5 + 1e-12);
  EXPECT_GE(smallest.minCoeff(), -0.5 - 1e-12);
  EXPECT_GT((largest - smallest).minCoeff(), 0.98);
}

// Sums (H.30) of the weights (H.29), theory-comparison.md.
TEST(Scatter, GivesEachPointTheAreaLawAndNearlyNoForce)
{
  for (const double scatter : {0.25, 0.5})
  {
    const TriangularLattice lattice = sheet(24., scatter);
    const ScatteredBonds &bonds = *lattice.scattered();
    latcon::support::LargestError sums;
    double odd = 0., before = 0.;
    for (const std::size_t place : sheets::sites(lattice))
    {
      std::array<double, 2> sum{};
      std::array<Eigen::Vector2d, 2> pull{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()}, raw = pull;
      for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
        for (const auto &[bond, sense] :
             {std::pair(lattice.bond(place, kind), 1.), std::pair(lattice.bond_into(place, kind), -1.)})
        {
          const double weight = bonds.weights[kind][bond.near];
          EXPECT_EQ(weight > 0., lattice.has_bond(bond.near, kind));
          if (!(weight > 0.))
            continue;
          const Eigen::Vector2d R = lattice.bond_vector(bond);
          const double l = lattice.ring_radius(kind), tent = 1. - std::abs(R.norm() - l) / lattice.spacing();
          EXPECT_GT(tent, 0.);
          sum[lattice.shell(kind)] += weight;
          pull[lattice.shell(kind)] += sense * weight * l / R.squaredNorm() * R;
          raw[lattice.shell(kind)] += sense * tent * l / R.squaredNorm() * R;
        }
      for (const std::size_t shell : {0, 1})
      {
        sums.add(std::abs(sum[shell] - 2.));
        odd += pull[shell].squaredNorm();
        before += raw[shell].squaredNorm() / (shell == 0 ? 50. : 130.); // sums of tents are 7 and 11
      }
    }
    EXPECT_LT(sums.error(), 1e-9);
    EXPECT_LT(odd, 0.02 * before) << scatter;
  }
}

// The highest frequency of any point, were its bonds all in line, against what steps are made for.
TEST(Scatter, HasTimeStepsForTheMostCrowdedPoint)
{
  const TriangularLattice lattice = sheet(24.);
  const Material material = without_dashpots(sheets::rubber());
  const State state = homogeneous_state(lattice, material, Eigen::Matrix2d::Identity(), Edges::held);
  double highest = 0.;
  for (const std::size_t place : sheets::sites(lattice))
  {
    double rate = 0.;
    for_each_bond_of_site(state, lattice, place,
                          [&](const Bond &bond)
                          {
                            const Shell &shell = *material.shell(lattice, bond.kind);
                            rate += 2. * state.stiffness.of(bond.near, bond.kind) *
                                    cross_section(shell, lattice, bond.kind) * stiffness(shell.law, 1.) *
                                    std::pow(lattice.length_ratio(bond.near, bond.kind), 2) /
                                    lattice.rest_length(bond.kind) / site_mass(material, lattice);
                          });
    highest = std::max(highest, rate);
  }
  const double allowed = std::pow(2. / time_step_limits(lattice, material, 1.).elastic, 2);
  EXPECT_LE(highest, allowed * (1. + 1e-12));
  EXPECT_GT(highest, 0.8 * allowed); // the most crowded points of both rings are not one
}

TEST(Scatter, CountsTheBondsOfEachPointForTheTip)
{
  const TriangularLattice lattice = sheet(24.);
  const Material material = sheets::rubber();
  const std::size_t place = lattice.index(lattice.rows() / 2, lattice.columns() / 2);
  State state = homogeneous_state(lattice, material, Eigen::Matrix2d::Identity(), Edges::held);
  unsigned int bonds = 0;
  for_each_bond_of_site(state, lattice, place, [&](const Bond &) { ++bonds; });
  EXPECT_EQ(material.coordination(lattice, place), bonds);
  EXPECT_NEAR(material.mean_coordination(lattice), bonds, 0.25 * bonds);
  Fracture fracture(lattice, material, 3., NoToughening(), Eigen::Matrix2d::Identity());
  state.lost_bonds[place] = static_cast<std::uint8_t>((bonds + 3) / 4 - 1);
  fracture.locate_tip(state);
  EXPECT_FALSE(fracture.tip());
  ++state.lost_bonds[place];
  fracture.locate_tip(state);
  EXPECT_EQ(fracture.tip(), place);
}

// Forces of a sheet without edges: of each site those of its bonds one by one, and none in sum.
TEST(Scatter, HasNoEdgesInAPeriodicSheet)
{
  const Grid grid{Grid::Kind::square, d / 1.5};
  const std::vector<Ring> rings = lattice_rings(d, Orientation::rows_along_crack, M_PI / 6.);
  const TriangularLattice lattice(grid, ring_stencil(grid, rings), d, 16. * d, 16. * d, {true, true});
  const Material material = sheets::rubber();
  State state = homogeneous_state(lattice, material, sheets::stretched(1.6, 1.3), Edges::held);
  const auto forces = [&](const State &at)
  {
    Forces forces(lattice, material);
    forces.evaluate(at, at.vx, at.vy);
    return std::pair(forces.fx(), forces.fy());
  };
  add_noise(state, lattice, 0.05 * d, 3);
  const auto [fx, fy] = forces(state);
  latcon::support::Extremes sizes;
  double rest_x = 0., rest_y = 0.;
  for (const std::size_t place : sheets::sites(lattice))
  {
    const Eigen::Vector2d force(fx[place], fy[place]);
    sizes.add(force.norm());
    rest_x += force.x();
    rest_y += force.y();
    EXPECT_LT((force - Forces(lattice, material).on_site(state, state.vx, state.vy, place)).norm(),
              1e-12 * force.norm() + 1e-15);
  }
  EXPECT_LT(std::hypot(rest_x, rest_y), 1e-10 * sizes.largest());
}

} // namespace lattice_scatter_test
