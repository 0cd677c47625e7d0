// Forces and inertia of gradient energy on a grid with damage.
#include "continuum/damage/damage_motion.h"
#include "continuum/damage/patch_bound.h"
#include "continuum/network_gradient.h"
#include "damaged_sheets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gradient_forces_test
{

using namespace damaged_sheets;

std::vector<double> random_factors(const std::size_t n)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> some(0., 1.);
  std::vector<double> factors(n);
  for (double &factor : factors)
    factor = some(random);
  return factors;
}

bool is_inside(const NodeGrid &grid, const std::size_t a, const std::size_t margin = 1)
{
  const std::size_t i = a % grid.columns(), j = a / grid.columns();
  return i >= margin && i + margin <= grid.cells_x && j >= margin && j + margin <= grid.cells_y;
}

// theory-damage.md, eqs. (C.75) and (C.76).
TEST(GradientForces, CarryTheEnergyOfTheLaw)
{
  // Differences of a quadratic field are exact: the energy of a node is that of the law.
  const NodeGrid grid(Rectangle{36., 4., 40, 5}); // more nodes in a row than are evaluated together
  const double l_d = 0.6 * spacing;
  const auto turned = in_all_directions(lattice(), NetworkGradient::n_directions);
  const LatticeGradient law(lattice(), l_d);
  const NetworkGradient network(lattice(), l_d);
  for (const Tensor<2, 2> &F0 : {matrix(1., 0., 0., 1.), matrix(2.3, 0.1, -0.2, 2.8), matrix(2., 0., 0., 0.8)})
  {
    const GradientForces of_lattice(grid, lattice(), l_d, F0), of_network(grid, turned, l_d, F0);
    GradientLaw::Gradient G;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          G[i][J][K] = 2e-3 * (1. + i - 2. * (J + K) + 3. * J * K);
    const GridVector u = nodal(grid,
                               [&](const Point<2> &X)
                               {
                                 Tensor<1, 2> value;
                                 for (unsigned int i = 0; i < 2; ++i)
                                   for (unsigned int J = 0; J < 2; ++J)
                                     for (unsigned int K = 0; K < 2; ++K)
                                       value[i] += 0.5 * G[i][J][K] * X[J] * X[K];
                                 return value;
                               });
    std::vector<double> energies, network_energies;
    of_lattice.energies(u, energies);
    of_network.energies(u, network_energies);
    for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    {
      Tensor<2, 2> F = F0;
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int K = 0; K < 2; ++K)
            F[i][J] += G[i][J][K] * grid.position(a)[K];
      const bool inside = is_inside(grid, a);
      const double expected = inside ? grid.area() * law.energy(F, G) : 0.;
      const double of_mean = inside ? grid.area() * network.energy(F, G) : 0.;
      // Round-off of second differences: 1e-16 u / h^2 over G, with u up to 500 G h^2.
      EXPECT_NEAR(energies[a], expected, 1e-12 * expected);
      EXPECT_NEAR(network_energies[a], of_mean, 1e-12 * of_mean);
    }
    // Homogeneous fields have none.
    of_lattice.energies(nodal(grid, [](const Point<2> &X) { return 0.1 * X; }), energies);
    for (const double E : energies)
      EXPECT_NEAR(E, 0., 1e-20 * 1e6); // square of the round-off 1e-14 of second differences, times the stiffness
  }
}

// theory-damage.md, eq. (C.79).
TEST(GradientForces, AreTheGradientOfTheDegradedEnergy)
{
  const NodeGrid grid(Rectangle{4., 4.4, 4, 4});
  const std::vector<double> factors = random_factors(grid.n_nodes());
  // Fibres in tension, in compression with a few below the shortest stretch, and in between.
  struct Case
  {
    Tensor<2, 2> loading;
    double amplitude, tolerance;
  };
  // Central differences with steps of 1e-6: round-off 1e-16 E/1e-6 of E about 1e6, and 1e-12/6 times third derivatives,
  // which are of the order of the force, 1e6, or, where the transverse stiffness sets in over 0.02, 60/0.02^3 times
  // psi'/l < 0.06 of it.
  for (const Case &c : {Case{matrix(2.3, 0.1, 0., 2.8), 0.1, 1e-9}, Case{matrix(0.6, 0., 0., 0.3), 0.2, 1e-6},
                        Case{matrix(1., 0., 0., 1.01), 0.02, 1e-6}})
  {
    const GradientForces forces(grid, lattice(), 0.5 * spacing, c.loading);
    GridVector u = random_field(grid, c.amplitude),
               force = nodal(grid, [](const Point<2> &) { return Tensor<1, 2>(); });
    forces.add_forces(u, factors, force);
    const auto energy = [&]
    {
      std::vector<double> nodes;
      forces.energies(u, nodes);
      double sum = 0.;
      for (std::size_t a = 0; a < nodes.size(); ++a)
        sum += factors[a] * nodes[a];
      return sum;
    };
    double scale = 0.;
    for (const double f : force[0])
      scale += std::abs(f);
    EXPECT_GT(scale, 0.);
    constexpr double step = 1e-6;
    for (const unsigned int i : {0u, 1u})
      for (std::size_t a = 0; a < grid.n_nodes(); ++a)
      {
        const double before = u[i][a];
        u[i][a] = before + step;
        const double high = energy();
        u[i][a] = before - step;
        const double low = energy();
        u[i][a] = before;
        EXPECT_NEAR(force[i][a], -(high - low) / (2. * step), c.tolerance * scale) << c.amplitude << ' ' << a;
      }
  }
}

// theory-damage.md, eqs. (C.78) and (C.80).
TEST(MassOperator, InvertsTheMassOfDamagedSheets)
{
  const NodeGrid grid(Rectangle{6., 4.4, 6, 4});
  std::array<std::vector<char>, 2> held{std::vector<char>(grid.n_nodes(), 0), std::vector<char>(grid.n_nodes(), 0)};
  std::fill(held[1].begin(), held[1].begin() + 7, 1); // the lowest row, in Y
  for (const double length : {0., 0.3, 2.})
  {
    MassOperator mass(grid, 950., length, held);
    // Energy of a linear velocity of the undamaged sheet: the micro-inertia of Grad v.
    const GridVector linear = nodal(grid,
                                    [](const Point<2> &X) {
                                      return Tensor<1, 2>({2. * X[0] + X[1], 3. * X[1]});
                                    });
    const double translation = MassOperator(grid, 950., 0., held).kinetic_energy(linear);
    const double expected = translation + 0.5 * 950. * length * length * 14. * 6. * 4.4;
    EXPECT_NEAR(mass.kinetic_energy(linear), expected, 1e-13 * expected);

    std::vector<double> factors = random_factors(grid.n_cells());
    factors[5] = factors[6] = 1e-6;
    mass.update(factors);
    GridVector v = random_field(grid, 1.), force(v);
    for (std::size_t i = 0; i < grid.columns(); ++i)
      v[1][i] = 0.;
    double energy = 0.;
    for (const unsigned int d : {0u, 1u})
    {
      mass.multiply(v[d], force[d]);
      for (std::size_t a = 0; a < grid.n_nodes(); ++a)
        energy += 0.5 * v[d][a] * force[d][a];
    }
    EXPECT_NEAR(mass.kinetic_energy(v), energy, 1e-13 * energy);
    mass.solve(force);
    for (const unsigned int d : {0u, 1u})
      for (std::size_t a = 0; a < grid.n_nodes(); ++a)
      {
        EXPECT_TRUE(!held[d][a] || force[d][a] == 0.);
        force[d][a] -= v[d][a];
      }
    // Bound of the iteration in the norm of M, twice its square as energies, and round-off.
    EXPECT_LE(mass.kinetic_energy(force), (std::pow(MassOperator::tolerance, 2) + 1e-28) * mass.kinetic_energy(v))
      << length;
  }
  EXPECT_THROW(MassOperator(grid, 950., std::nan(""), held), InvalidInput);
  EXPECT_THROW(MassOperator(grid, 950., 1e6, held), InvalidInput);
}

// theory-damage.md, eq. (C.82).
TEST(GradientForces, HaveTheDispersionOfTheLatticeOnAGrid)
{
  // Plane waves of the semi-discrete sheet: k^2 becomes (2 sin(k h/2) / h)^2, exactly. Forces and masses are compared,
  // so that nothing needs to be solved.
  const Tensor<2, 2> F = matrix(2.3, 0., 0., 2.8);
  const double l_d = 0.5 * spacing, k = 1.2 / spacing, amplitude = 1e-7;
  const NodeGrid grid(Rectangle{12 * 0.5, 10 * 0.4, 12, 10});
  const GradientForces gradient(grid, lattice(), l_d, F);
  const FibreForces local(grid, fibres(lattice()), {}, F);
  const MassOperator mass(grid, 1., l_d, {std::vector<char>(grid.n_nodes(), 0), std::vector<char>(grid.n_nodes(), 0)});
  for (const unsigned int J : {0u, 1u})
    for (const unsigned int i : {0u, 1u})
    {
      const GridVector u = nodal(grid,
                                 [&](const Point<2> &X)
                                 {
                                   Tensor<1, 2> value;
                                   value[i] = amplitude * std::sin(k * X[J] + 0.3);
                                   return value;
                                 });
      GridVector force;
      local.forces(u, u, std::vector<double>(grid.n_cells(), 1.), force);
      gradient.add_forces(u, std::vector<double>(grid.n_nodes(), 1.), force);
      std::vector<double> inertia;
      mass.multiply(u[i], inertia);
      const double h = J == 0 ? grid.size_x : grid.size_y, K = std::pow(2. / h * std::sin(0.5 * k * h), 2);
      const double omega2 = stiffness_of_waves(F, J, i, K, l_d, l_d);
      const double scale = omega2 * amplitude * grid.area();
      // Non-linear terms: the strain 1.2e-7 times derivatives of the stiffness by it, which are below 10.
      for (std::size_t a = 0; a < grid.n_nodes(); ++a)
      {
        if (!is_inside(grid, a, 2))
          continue;
        EXPECT_NEAR(force[i][a], -omega2 * inertia[a], 2e-6 * scale) << J << ' ' << i << ' ' << a;
      }
      // Error of second order in h: the derivative by K times k^4 h^2 / 12.
      double error[2];
      for (const unsigned int n : {0u, 1u})
      {
        const double size = 0.1 / (n + 1.), own = std::pow(2. / size * std::sin(0.5 * k * size), 2);
        error[n] = stiffness_of_waves(F, J, i, own, l_d, l_d) - stiffness_of_waves(F, J, i, k * k, l_d, l_d);
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), 2., 0.01);
    }
}

} // namespace gradient_forces_test
