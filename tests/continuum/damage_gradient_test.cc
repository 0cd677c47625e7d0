// Gradient energy and micro-inertia in the motion with damage (theory-damage.md, eqs. (C.75) to (C.82)).
#include "continuum/damage/damage_motion.h"
#include "continuum/damage/patch_bound.h"
#include "continuum/errors.h"
#include "continuum/network_gradient.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <random>

namespace damage_gradient_test
{

using namespace latcon::continuum;
using dealii::Point;
using dealii::Tensor;

constexpr double pi = 3.14159265358979323846;
constexpr double spacing = 1.; // of the bonds [m]

Tensor<2, 2> matrix(const double xx, const double xy, const double yx, const double yy)
{
  const double F[2][2] = {{xx, xy}, {yx, yy}};
  return Tensor<2, 2>(F);
}

// Triangular lattice with both shells, of rubber.
std::vector<BondFamily> lattice()
{
  std::vector<BondFamily> bonds;
  for (unsigned int k = 0; k < 6; ++k)
  {
    const Tensor<1, 2> N({std::cos(pi * k / 6.), std::sin(pi * k / 6.)});
    bonds.push_back(
      {{N, k % 2 == 0 ? 0.7 : 1.4, RodPotential{1e5, 1.5e5}}, (k % 2 == 0 ? 1. : std::sqrt(3.)) * spacing});
  }
  return bonds;
}

std::vector<FibreFamily> fibres(const std::vector<BondFamily> &bonds)
{
  std::vector<FibreFamily> fibres;
  for (const BondFamily &bond : bonds)
    fibres.push_back(bond.fibre);
  return fibres;
}

GridVector nodal(const NodeGrid &grid, const std::function<Tensor<1, 2>(const Point<2> &)> &field)
{
  GridVector u;
  for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    for (const unsigned int i : {0u, 1u})
      u[i].push_back(field(grid.position(a))[i]);
  return u;
}

GridVector random_field(const NodeGrid &grid, const double amplitude)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(-amplitude, amplitude);
  return nodal(grid,
               [&](const Point<2> &)
               {
                 const double x = some(random);
                 return Tensor<1, 2>({x, some(random)});
               });
}

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

// rho omega^2 of a wave along X_J with polarisation along x_i, at k^2 = K, eqs. (C.47) and (C.82).
double stiffness_of_waves(const Tensor<2, 2> &F, const unsigned int J, const unsigned int i, const double K,
                          const double l_d, const double inertia)
{
  double A_2 = 0., A_4 = 0.;
  for (const BondFamily &bond : lattice())
  {
    const Tensor<1, 2> &N = bond.fibre.direction;
    const Tensor<1, 2> f = F * N;
    const double l = f.norm(), n = f[i] / l;
    const PotentialDerivatives psi = derivatives(bond.fibre.potential, l);
    const double h = bond.fibre.weight * (psi.second * n * n + psi.first / l * (1. - n * n));
    A_2 += h * N[J] * N[J];
    A_4 += h * std::pow(bond.length, 2) * std::pow(N[J], 4) / 12.;
  }
  return (A_2 * K + (l_d * l_d * A_2 - A_4) * K * K) / (1. + inertia * inertia * K);
}

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
      // Of second order in h: the derivative by K times k^4 h^2 / 12.
      double error[2];
      for (const unsigned int n : {0u, 1u})
      {
        const double size = 0.1 / (n + 1.), own = std::pow(2. / size * std::sin(0.5 * k * size), 2);
        error[n] = stiffness_of_waves(F, J, i, own, l_d, l_d) - stiffness_of_waves(F, J, i, k * k, l_d, l_d);
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), 2., 0.01);
    }
}

DamageMotionSetup sheet(const Tensor<2, 2> &F, const Rectangle &rectangle, const double step)
{
  DamageMotionSetup setup{
    rectangle, F,   fibres(lattice()), {}, 950., {1e9, spacing}, [](const Point<2> &, unsigned int) { return false; },
    {},        step};
  setup.gradient = GradientSetup{lattice(), 0.5 * spacing};
  return setup;
}

std::vector<FibreDashpot> dashpots(const double viscosity)
{
  std::vector<FibreDashpot> all;
  for (const FibreFamily &fibre : fibres(lattice()))
    all.push_back({fibre.direction, fibre.weight, viscosity});
  return all;
}

TEST(DamageMotion, MovesWavesAsTheirDispersionSays)
{
  // One step from rest, in the middle of a sheet that is large enough: the mass operator forgets an edge as
  // exp(-0.9 y/h) or faster.
  constexpr unsigned int n = 50;
  const Tensor<2, 2> F = matrix(2.3, 0., 0., 2.8);
  const double h = 0.5 * spacing, k = 1.2 / spacing, amplitude = 1e-7;
  const double K = std::pow(2. / h * std::sin(0.5 * k * h), 2);
  for (const bool has_micro_inertia : {true, false})
    for (const double d : {0., 0.5})
    {
      const double omega2 =
        stiffness_of_waves(F, 0, 0, K, 0.5 * spacing, has_micro_inertia ? 0.5 * spacing : 0.) / 950.;
      const double step = 0.02 / std::sqrt(omega2);
      DamageMotionSetup setup = sheet(F, {n * h, n * h, n, n}, step);
      setup.gradient->has_micro_inertia = has_micro_inertia;
      DamageMotion motion(setup);
      motion.set_damage([d](const Point<2> &) { return d; });
      motion.set_motion(
        [&](const Point<2> &X) {
          return Tensor<1, 2>({amplitude * std::cos(k * (X[0] - 12.5)), 0.});
        },
        [](const Point<2> &) { return Tensor<1, 2>(); });
      EXPECT_GT(motion.ledger().gradient, 0.);
      motion.advance();
      const std::size_t middle = n / 2 * motion.grid().columns() + n / 2;
      const double moved = motion.displacement()[0][middle] / amplitude - 1.;
      // Non-linear terms and the tolerance of the mass operator: 1e-6 of omega^2.
      EXPECT_NEAR(moved, -0.5 * omega2 * step * step, 1e-6 * omega2 * step * step) << has_micro_inertia << ' ' << d;
    }
}

// Change of the velocity of the lower half within a step, caused by opening the upper half.
double transmitted(const bool is_broken)
{
  GridVector velocity[2];
  for (const bool is_open : {false, true})
  {
    DamageMotion motion(sheet(matrix(2.3, 0., 0., 2.8), {6., 4.5, 12, 9}, 1e-4));
    if (is_broken)
      motion.set_damage([](const Point<2> &X) { return std::abs(X[1]) < 0.26 ? 1. : 0.; });
    const GridVector rough = random_field(motion.grid(), 0.02);
    std::size_t a = 0;
    motion.set_motion(
      [&](const Point<2> &X)
      {
        const std::size_t own = a++;
        return is_open && X[1] > 0. ? Tensor<1, 2>({rough[0][own], 1. + rough[1][own]}) : Tensor<1, 2>();
      },
      [](const Point<2> &) { return Tensor<1, 2>(); });
    motion.advance();
    velocity[is_open ? 1 : 0] = motion.velocity();
  }
  double sum = 0.;
  for (const unsigned int i : {0u, 1u})
    for (std::size_t a = 0; a < 13 * 5; ++a) // the lower five rows of nodes
      sum += std::pow(velocity[1][i][a] - velocity[0][i][a], 2);
  return std::sqrt(sum);
}

TEST(DamageMotion, TransmitsNothingAcrossABrokenLine)
{
  // All that crosses the line has the factor k; the nodes beside it have lost half of their mass.
  EXPECT_GT(transmitted(false), 0.);
  const DamageLaw law{1., 1.};
  EXPECT_LT(transmitted(true), 10. * law.residual_stiffness * transmitted(false));
}

// Energies after `time` of a sheet with a wave and, if `viscosity` > 0, dashpots.
DamageMotionLedger wave_ledger(const double viscosity, const double step, const double time)
{
  DamageMotionSetup setup = sheet(matrix(2.3, 0., 0., 2.8), {5., 4., 10, 8}, step);
  setup.is_held = [](const Point<2> &X, unsigned int)
  { return X[0] < 1e-9 || X[0] > 5. - 1e-9 || std::abs(X[1]) > 2. - 1e-9; };
  setup.dashpots = viscosity > 0. ? dashpots(viscosity) : std::vector<FibreDashpot>();
  DamageMotion motion(setup);
  motion.set_damage([](const Point<2> &X) { return 0.1 * X[0]; });
  motion.set_motion(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.1 * std::sin(pi * X[0] / 2.5), 0.});
    },
    [](const Point<2> &) { return Tensor<1, 2>(); });
  while (motion.time() < time - 0.5 * step)
    motion.advance();
  return motion.ledger();
}

TEST(DamageMotion, ClosesTheLedgerWithGradientEnergy)
{
  for (const double viscosity : {0., 300.})
  {
    const DamageMotionLedger coarse = wave_ledger(viscosity, 2e-4, 0.02), fine = wave_ledger(viscosity, 1e-4, 0.02);
    EXPECT_GT(fine.kinetic, 0.);
    EXPECT_GT(fine.gradient, 0.);
    // Of second order in the step, or better where that term is small.
    EXPECT_GT(std::log2(std::abs(coarse.imbalance / fine.imbalance)), 1.5) << viscosity;
    EXPECT_LT(std::abs(fine.imbalance), 1e-3 * (fine.kinetic + fine.gradient)) << viscosity;
  }
}

bool is_accepted(const DamageMotionSetup &setup)
{
  try
  {
    DamageMotion{setup};
    return true;
  }
  catch (const InvalidInput &)
  {
    return false;
  }
}

TEST(DamageMotion, IsStableUpToTheStepThatItStates)
{
  // Noise on a sheet without pre-stretch does not grow, whatever its damage; with it, damage would set it in motion.
  for (const bool has_micro_inertia : {true, false})
    for (const auto &[viscosity, is_stretched] :
         {std::pair(0., false), std::pair(0., true), std::pair(3e3, false), std::pair(3e3, true)})
    {
      const Tensor<2, 2> F = is_stretched ? matrix(2.3, 0., 0., 2.8) : matrix(1., 0., 0., 1.);
      DamageMotionSetup setup = sheet(F, {3., 3., 8, 8}, 1e-9);
      setup.gradient->has_micro_inertia = has_micro_inertia;
      setup.step = 0.99 * DamageMotion(setup).stable_step();
      if (viscosity > 0.)
      {
        setup.dashpots = dashpots(viscosity);
        while (!is_accepted(setup))
          setup.step *= 0.98;
      }
      setup.is_held = [](const Point<2> &X, unsigned int)
      { return X[0] < 1e-9 || X[0] > 3. - 1e-9 || std::abs(X[1]) > 1.5 - 1e-9; };
      DamageMotion motion(setup);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> some(0., 1.);
      if (!is_stretched)
        motion.set_damage([&](const Point<2> &) { return some(random); });
      motion.set_motion(
        [&](const Point<2> &) {
          return 1e-8 * some(random) * Tensor<1, 2>({1., -0.7});
        },
        [](const Point<2> &) { return Tensor<1, 2>(); });
      for (unsigned int step = 0; step < 150; ++step)
        motion.advance();
      double sum = 0.;
      for (std::size_t b = 0; b < motion.grid().n_nodes(); ++b)
        sum += std::pow(motion.displacement()[0][b], 2) + std::pow(motion.displacement()[1][b], 2);
      // Far above the noise, far below growth by 1 % a step.
      EXPECT_LT(std::sqrt(sum), 3e-6) << has_micro_inertia << ' ' << viscosity << ' ' << is_stretched;
      setup.step *= 1.03;
      EXPECT_FALSE(is_accepted(setup));
    }
}

TEST(DamageMotion, HasTheSameBitsWithGradientEnergyOnAnyNumberOfThreads)
{
  GridVector u[2];
  const int threads = omp_get_max_threads();
  for (const int n : {0, 1})
  {
    omp_set_num_threads(n + 1);
    DamageMotionSetup setup = sheet(matrix(1.3, 0., 0., 1.5), {36.5, 35., 73, 70}, 1e-3); // large enough for threads
    setup.dashpots = dashpots(300.);
    DamageMotion motion(setup);
    motion.set_damage([](const Point<2> &X) { return std::abs(X[1]) < 0.6 && X[0] < 10. ? 1. : 0.; });
    for (unsigned int step = 0; step < 2; ++step)
      motion.advance();
    u[n] = motion.displacement();
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(u[0], u[1]);
}

TEST(DamageMotion, RefusesInvalidGradients)
{
  const DamageMotionSetup setup = sheet(matrix(1., 0., 0., 1.), {4., 4., 8, 8}, 1e-5);
  EXPECT_NO_THROW(DamageMotion{setup});
  DamageMotionSetup wrong = setup;
  for (const double length : {0., -1., std::nan("")})
  {
    wrong.gradient->length = length;
    EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  }
  wrong.gradient->length = 0.49 * spacing; // less than eq. (C.26)
  EXPECT_THROW(DamageMotion{wrong}, InvalidMaterial);
  wrong = setup;
  wrong.gradient->bonds.clear();
  EXPECT_THROW(DamageMotion{wrong}, InvalidMaterial);
}

} // namespace damage_gradient_test
