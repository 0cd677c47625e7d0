// Stages in time, forces and damage of a sheet on a grid.
#include "continuum/cauchy_born.h"
#include "continuum/damage/damage_motion.h"
#include "continuum/isotropic_network.h"
#include "damaged_sheets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

namespace damage_forces_test
{

using namespace damaged_sheets;

// theory-damage.md, eq. (C.73).
TEST(ViscousStages, AreOfSecondOrderAndStableToTheirLimit)
{
  for (const unsigned int n : {2u, 3u, 9u, 40u})
  {
    const ViscousStages method(n);
    // R(z) - e^z = O(z^3): the third derivatives of R are at most 1.
    for (const double z : {-1e-2, 1e-2})
      EXPECT_LT(std::abs(amplification(method, z) - std::exp(z)), 0.2 * std::abs(z * z * z)) << n;
    const double limit = ViscousStages::real_limit(n);
    for (unsigned int k = 0; k <= 1000; ++k)
      EXPECT_LE(std::abs(amplification(method, -limit * k / 1000.)), 1. + 1e-10) << n << ' ' << k;
    EXPECT_GT(std::abs(amplification(method, -1.5 * limit)), 1.) << n; // damped at the limit itself
    EXPECT_EQ(ViscousStages::required(limit * (1. - 1e-12)), n);
    EXPECT_EQ(ViscousStages::required(limit * (1. + 1e-12)), n + 1);
  }
  EXPECT_THROW(ViscousStages(1), InvalidInput);
  EXPECT_THROW(ViscousStages::required(std::nan("")), InvalidInput);
  EXPECT_THROW(ViscousStages::required(1e12), InvalidInput);
}

struct RandomSheet
{
  RandomSheet() : grid(Rectangle{3., 1.6, 3, 2})
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-0.1, 0.1);
    for (const unsigned int i : {0u, 1u})
      for (std::size_t a = 0; a < grid.n_nodes(); ++a)
      {
        u[i].push_back(some(random));
        v[i].push_back(some(random));
      }
    for (std::size_t c = 0; c < grid.n_cells(); ++c)
      factors.push_back(0.5 + some(random));
  }
  NodeGrid grid;
  GridVector u, v;
  std::vector<double> factors;
};

double energy(const FibreForces &forces, const RandomSheet &sheet)
{
  std::vector<double> cells;
  forces.energies(sheet.u, sheet.factors, cells);
  double sum = 0.;
  for (std::size_t c = 0; c < cells.size(); ++c)
    sum += sheet.factors[c] * cells[c];
  return sum;
}

// theory-damage.md, eq. (C.71).
TEST(FibreForces, AreTheGradientOfTheDegradedEnergy)
{
  std::vector<FibreFamily> fibres = springs();
  for (const FibreFamily &rod : rods())
    fibres.push_back(rod);
  RandomSheet sheet;
  const FibreForces forces(sheet.grid, fibres, dashpots(springs(), 50.), matrix(1.3, 0.1, 0., 1.5));
  const GridVector rest{std::vector<double>(sheet.grid.n_nodes(), 0.), std::vector<double>(sheet.grid.n_nodes(), 0.)};
  GridVector elastic, all;
  EXPECT_EQ(forces.forces(sheet.u, rest, sheet.factors, elastic), 0.);
  constexpr double step = 1e-5; // central differences: 1e-10 of third derivatives, 1e-16/1e-5 of round-off
  const double scale = 1e6;     // force of a spring at a strain of 1
  for (const unsigned int i : {0u, 1u})
    for (std::size_t a = 0; a < sheet.grid.n_nodes(); ++a)
    {
      const double before = sheet.u[i][a];
      sheet.u[i][a] = before + step;
      const double high = energy(forces, sheet);
      sheet.u[i][a] = before - step;
      const double low = energy(forces, sheet);
      sheet.u[i][a] = before;
      EXPECT_NEAR(elastic[i][a], -(high - low) / (2. * step), 1e-8 * scale);
    }
  // The dissipated power is that of the viscous forces.
  const double power = forces.forces(sheet.u, sheet.v, sheet.factors, all);
  double work = 0.;
  for (const unsigned int i : {0u, 1u})
    for (std::size_t a = 0; a < sheet.grid.n_nodes(); ++a)
      work += (all[i][a] - elastic[i][a]) * sheet.v[i][a];
  EXPECT_GT(power, 0.);
  EXPECT_NEAR(power, -work, 1e-12 * scale);
}

TEST(FibreForces, AgreeWithTheLawsOfOtherSheets)
{
  RandomSheet sheet;
  for (std::vector<double> &component : sheet.u)
    std::fill(component.begin(), component.end(), 0.);
  const Tensor<2, 2> F = matrix(2.3, 0.2, -0.1, 2.8);
  std::vector<double> cells;
  FibreForces(sheet.grid, rods(), {}, F).energies(sheet.u, sheet.factors, cells);
  const double W = CauchyBorn(rods()).energy(F);
  for (const double E : cells)
    EXPECT_NEAR(E, W * sheet.grid.area(), 1e-14 * W);
  FibreForces(sheet.grid, in_all_directions(rods(), 12), {}, F).energies(sheet.u, sheet.factors, cells);
  const double network = IsotropicNetwork(rods()).energy(F);
  for (const double E : cells) // principal stretches differ by less than a tenth of their sum
    EXPECT_NEAR(E, network * sheet.grid.area(), 1e-11 * network);

  // A cell that is inverted is an error unless it is broken.
  for (std::size_t j = 0; j < sheet.grid.rows(); ++j)
    sheet.u[0][j * sheet.grid.columns() + 1] = -3. * 2.3;
  const FibreForces forces(sheet.grid, rods(), {}, F);
  std::fill(sheet.factors.begin(), sheet.factors.end(), 1.);
  EXPECT_THROW(forces.energies(sheet.u, sheet.factors, cells), NonPhysicalState);
  std::fill(sheet.factors.begin(), sheet.factors.end(), 1e-3);
  EXPECT_NO_THROW(forces.energies(sheet.u, sheet.factors, cells));
}

class GridDamageMinimum : public testing::TestWithParam<bool>
{
};

// theory-damage.md, eqs. (C.70) and (C.77): without and with energies of nodes.
TEST_P(GridDamageMinimum, IsTheLowestOfTheEnergyAndNeverHeals)
{
  const NodeGrid grid(Rectangle{12., 10., 12, 10});
  const DamageLaw law{1., 2., 1e-6};
  std::vector<char> intact(grid.n_nodes(), 0);
  for (std::size_t i = 0; i < grid.columns(); ++i)
    intact[i] = 1;
  GridDamage field(grid, law, intact);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(0., 4.);
  std::vector<double> energies(grid.n_cells()), of_nodes(GetParam() ? grid.n_nodes() : 0);
  const auto total = [&](const GridDamage &damage)
  {
    double sum = damage.fracture_energy();
    for (std::size_t c = 0; c < energies.size(); ++c)
      sum += damage.cell_factors()[c] * energies[c];
    for (std::size_t a = 0; a < of_nodes.size(); ++a)
      sum += damage.node_factors()[a] * of_nodes[a];
    return sum;
  };
  for (unsigned int round = 0; round < 3; ++round)
  {
    for (std::vector<double> *part : {&energies, &of_nodes})
      for (double &E : *part)
        E = some(random) * (round == 1 ? 0.1 : 1.);
    const std::vector<double> before = field.nodal();
    const bool changed = field.minimize(energies, of_nodes);
    EXPECT_EQ(changed, round != 1); // a tenth of the energies drives nothing
    const double lowest = total(field);
    // First-order conditions: no admissible change of one node lowers the energy.
    for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    {
      const double d = field.nodal()[a];
      EXPECT_GE(d, before[a]);
      EXPECT_LE(d, 1.);
      if (intact[a])
      {
        EXPECT_EQ(d, 0.);
        continue;
      }
      constexpr double change = 1e-3; // raises E by 1e-6 of its curvature, much more than the tolerance 1e-7 lowers it
      for (const double sign : {-1., 1.})
        if (const double other = d + sign * change; other >= before[a] && other <= 1.)
        {
          GridDamage moved(grid, law, intact);
          std::vector<double> nodal = field.nodal();
          nodal[a] = other;
          moved.set(nodal);
          EXPECT_GT(total(moved), lowest) << round << ' ' << a << ' ' << sign;
        }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WithEnergiesOfNodes, GridDamageMinimum, testing::Bool());

TEST(GridDamage, OfAHomogeneousSheetIsInClosedForm)
{
  // eq. (C.66): 1 - phi = W_c/W.
  const NodeGrid grid(Rectangle{6., 5., 6, 5});
  GridDamage field(grid, {1., 2., 1e-6});
  EXPECT_FALSE(field.minimize(std::vector<double>(grid.n_cells(), 1. - 1e-6)));
  EXPECT_TRUE(field.minimize(std::vector<double>(grid.n_cells(), 4.)));
  for (const double d : field.nodal())
    EXPECT_NEAR(d, 0.75, 1e-5); // 100 times the tolerance of the iteration
  const double uniform = field.nodal()[0];
  EXPECT_NEAR(field.fracture_energy(), 2. * (1. - 1e-6) * 30. * uniform, 1e-3);
  EXPECT_THROW(field.set(std::vector<double>(grid.n_nodes(), 1.1)), InvalidInput);
  EXPECT_THROW(field.minimize(std::vector<double>(grid.n_cells(), std::nan(""))), NonPhysicalState);
  EXPECT_THROW(GridDamage(NodeGrid(Rectangle{6., 5., 6, 2}), {1., 2.}), InvalidInput);
}

} // namespace damage_forces_test
