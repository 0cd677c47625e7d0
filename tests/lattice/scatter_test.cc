// Stencils of rings and scattered points: weights of their bonds. Energies and waves:
// tests/verification/claims/nonlocal_test.cc.
#include "lattice/scatter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/fracture.h"
#include "lattice/stencil.h"
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
    double odd = 0., before = 0., shortest = HUGE_VAL;
    for (const std::size_t place : lattice.sites())
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
          EXPECT_NEAR(lattice.length_ratio(bond.near, kind) * R.norm(), lattice.rest_length(kind), 1e-12 * l);
          shortest = std::min(shortest, R.norm());
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
    EXPECT_NEAR(lattice.shortest_bond(), shortest, 1e-12 * shortest);
  }
}

// The highest frequency of any point, were its bonds all in line, against what steps are made for.
TEST(Scatter, HasTimeStepsForTheMostCrowdedPoint)
{
  const TriangularLattice lattice = sheet(24.);
  const Material material = without_dashpots(sheets::rubber());
  const State state = homogeneous_state(lattice, material, Eigen::Matrix2d::Identity(), Edges::held);
  double highest = 0.;
  for (const std::size_t place : lattice.sites())
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
  EXPECT_NEAR(lattice.scattered()->bonds_of_point, bonds, 0.25 * bonds);
  Fracture fracture(lattice, material, 3., Toughening(), Eigen::Matrix2d::Identity());
  state.lost_bonds[place] = static_cast<std::uint8_t>((bonds + 3) / 4 - 1);
  fracture.locate_tip(state);
  EXPECT_FALSE(fracture.tip());
  ++state.lost_bonds[place];
  fracture.locate_tip(state);
  EXPECT_EQ(fracture.tip(), place);
}

using Stencil = std::vector<HalfBond>;

std::vector<Ring> all_directions()
{
  return lattice_rings(d, Orientation::rows_along_crack, M_PI / 6.);
}

Stencil isotropic(Grid::Kind kind, double m)
{
  return ring_stencil({kind, d / m}, all_directions());
}

double sum(const Stencil &stencil, std::size_t shell, const std::function<double(const HalfBond &)> &of_bond)
{
  double total = 0.;
  for (const HalfBond &bond : stencil)
    if (bond.shell == shell)
      total += bond.weight * of_bond(bond);
  return total;
}

/// Largest error of the second and fourth moments of directions.
double error_of_moments(const Stencil &stencil)
{
  double error = 0.;
  for (const std::size_t shell : {0, 1})
    for (int x = 0; x <= 4; ++x)
    {
      const double mean = sum(stencil, shell,
                              [&](const HalfBond &bond)
                              {
                                const double angle = std::atan2(bond.vector.y(), bond.vector.x());
                                return std::pow(std::cos(angle), x) * std::pow(std::sin(angle), 4 - x);
                              });
      const double exact[] = {3. / 8., 0., 1. / 8., 0., 3. / 8.};
      error = latcon::support::largest_of({error, std::abs(mean - exact[x])});
    }
  return error;
}

TEST(Stencil, HasTheMomentsOfAllDirections)
{
  for (const Grid::Kind kind : {Grid::Kind::triangular, Grid::Kind::square})
    for (const double m : {1.5, 2., 3., 4., 6.})
      EXPECT_LT(error_of_moments(isotropic(kind, m)), 1e-13) << static_cast<int>(kind) << ", m = " << m;
  EXPECT_EQ(isotropic(Grid::Kind::square, 2.).size(), 30u);
  EXPECT_EQ(isotropic(Grid::Kind::square, 3.).size(), 48u);
  for (const double degrees : {10., 20.})
    EXPECT_LT(error_of_moments(ring_stencil({Grid::Kind::square, d / 4.},
                                            lattice_rings(d, Orientation::rows_along_crack, degrees * M_PI / 180.))),
              1e-13)
      << degrees;
}

TEST(Stencil, RefusesWhatIsNoContinuum)
{
  const auto refuses = [](const Grid &grid, const std::vector<Ring> &rings)
  { EXPECT_THROW(ring_stencil(grid, rings), std::invalid_argument); };
  const auto narrow = lattice_rings(d, Orientation::rows_along_crack, 0.);
  refuses({Grid::Kind::square, d}, narrow);           // no bonds in the arcs
  refuses({Grid::Kind::triangular, 0.5 * d}, narrow); // four lattices in each other
  refuses({Grid::Kind::square, 0.}, all_directions());
  refuses({Grid::Kind::square, d}, {{-d, 0., 0}});
  refuses({Grid::Kind::square, d}, {{d, 0., n_shells}});
  refuses({Grid::Kind::square, d}, {{d, 0., 0, 1.}});
}

} // namespace lattice_scatter_test
