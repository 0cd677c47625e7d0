// Gradient part of Maxwell branches, compared with differences and closed forms.
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "continuum/rate_forces.h"
#include "memory_archive.h"
#include "moving_sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gradient_memory_test
{
using namespace moving_sheets;
using namespace latcon::continuum;

constexpr double spacing = 0.02; // [m]
constexpr double micro_length = 0.6 * spacing;
constexpr double modulus = 2e5;
const std::vector<double> times{2e-4, 3e-3};

const FibreMemory &memory()
{
  static const FibreMemory law = network_memory(modulus, times, micro_length);
  return law;
}

// A sheet with the gradient law of the bonds.
struct GradientSheet
{
  explicit GradientSheet(BoundaryConditions conditions = {}) : mesh(MPI_COMM_WORLD)
  {
    make_rectangle(mesh, rectangle(2, 2));
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.5 * length && cell->center()[1] < 0.5 * height)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
    sheet = std::make_unique<Sheet>(mesh, Constitution(law, gradient), 2, std::move(conditions));
  }

  const CauchyBorn law = rubber_network();
  const LatticeGradient gradient = rubber_gradient(spacing);
  Mesh mesh;
  std::unique_ptr<Sheet> sheet;
};

// The strains of the gradient part are the derivatives of the stretches across and along the fibres.
// theory-viscoelastic.md, eq. (V.9).
TEST(GradientMemory, HasTheGradientsOfStretches)
{
  std::mt19937 generator(41);
  const Tensor<2, 2> F = random_deformation(generator);
  const Tensor<3, 2> G = random_gradient(generator, spacing);
  std::vector<double> strains(memory().gradient()->n_strains());
  memory().gradient()->strains(field_derivatives(F, G), strains.data());
  std::size_t number = 0;
  for (const MaxwellFibres &fibres : memory().families())
  {
    const Tensor<1, 2> &N = fibres.direction;
    for (const Tensor<1, 2> &M : {Tensor<1, 2>({-N[1], N[0]}), N})
    {
      const auto stretch = [&](const double s)
      {
        Tensor<1, 2> f = F * N;
        for (unsigned int i = 0; i < 2; ++i)
          f[i] += s * (M * (G[i] * N));
        return f.norm();
      };
      const double step = 1e-4 * spacing;
      EXPECT_NEAR(strains[number++], (stretch(step) - stretch(-step)) / (2. * step), 1e-6 / spacing);
    }
  }
  EXPECT_EQ(number, strains.size());
}

// Sum over the quadrature points of all cells of density(X) dX.
template <class Density>
auto integrated(const GradientSheet &of, const Density &density)
{
  decltype(density(Point<2>())) sum{};
  const dealii::QGauss<2> points(3);
  for (const auto &cell : of.mesh.active_cell_iterators())
    if (cell->is_locally_owned())
      for (unsigned int q = 0; q < points.size(); ++q)
      {
        const Tensor<1, 2> size = cell->vertex(3) - cell->vertex(0);
        const Point<2> X(cell->vertex(0)[0] + size[0] * points.point(q)[0],
                         cell->vertex(0)[1] + size[1] * points.point(q)[1]);
        sum += points.weight(q) * cell->measure() * density(X);
      }
  return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
}

// A quadratic displacement, reached suddenly from rest and held: overstresses decay with their relaxation times, the
// energies are those of the closed form, and the history goes through an archive. It has no jumps, also at the edge
// with its prescribed normal gradient. theory-viscoelastic.md, eq. (V.9).
TEST(GradientMemory, RelaxesInAHeldSecondGradient)
{
  constexpr double load_factor = 0.7;
  std::mt19937 generator(42);
  const Tensor<3, 2> G = random_gradient(generator, length);
  const Tensor<2, 2> stretch = matrix(0.5, 0.1, 0., 0.4);
  const auto F = [&](const Point<2> &X)
  {
    Tensor<2, 2> sum = identity + stretch;
    for (unsigned int i = 0; i < 2; ++i)
      sum[i] += G[i] * Tensor<1, 2>(X);
    return sum;
  };
  BoundaryConditions conditions;
  conditions.normal_gradients = {{edge::right, std::make_shared<Field>(
                                                 [&](const Point<2> &X) {
                                                   return (F(X) - identity) * Tensor<1, 2>({1., 0.}) / load_factor;
                                                 })}};
  const GradientSheet of(conditions);
  const auto u = nodal(*of.sheet,
                       [&](const Point<2> &X)
                       {
                         Tensor<1, 2> sum = stretch * Tensor<1, 2>(X);
                         for (unsigned int i = 0; i < 2; ++i)
                           sum[i] += 0.5 * (X * (G[i] * Tensor<1, 2>(X)));
                         return sum;
                       });
  // Energy density of springs of unit modulus: that of the gradients alone, and of both.
  const auto of_gradients = [&](const Tensor<2, 2> &at)
  {
    double sum = 0.;
    for (const auto &bond : rubber_bonds(spacing))
    {
      const Tensor<1, 2> &N = bond.fibre.direction;
      const Tensor<1, 2> T({-N[1], N[0]});
      const Tensor<1, 2> n = at * N / (at * N).norm();
      double across = 0., along = 0.;
      for (unsigned int i = 0; i < 2; ++i)
      {
        across += n[i] * (T * (G[i] * N));
        along += n[i] * (N * (G[i] * N));
      }
      const double l_d2 = micro_length * micro_length;
      sum +=
        0.5 * bond.fibre.weight * (l_d2 * across * across + (l_d2 - bond.length * bond.length / 12.) * along * along);
    }
    return sum;
  };
  const double gradients = integrated(of, [&](const Point<2> &X) { return of_gradients(F(X)); });
  const double stretches =
    integrated(of,
               [&](const Point<2> &X)
               {
                 double sum = 0.;
                 for (const auto &bond : rubber_bonds(spacing))
                   sum += 0.5 * bond.fibre.weight * std::pow((F(X) * bond.fibre.direction).norm() - 1., 2);
                 return sum;
               });
  EXPECT_GT(gradients, 1e-4 * stretches);

  RateForces forces(*of.sheet, nullptr, &memory());
  const auto at_rest = of.sheet->make_ghosted();
  // The load factor of the rest is that of the deformed sheet: its normal gradient, too, must be the prescribed one.
  forces.start(u, load_factor, {u, u});
  for (const BranchEnergy &energy : forces.stored(u, load_factor))
    EXPECT_EQ(energy.stored, 0.);
  forces.start(at_rest, 0., {});
  std::vector<BranchEnergy> energies;
  forces.set_history(forces.advanced(0., u, load_factor, energies));
  const double tolerance = 1e-12 * modulus * (gradients + stretches);
  for (const BranchEnergy &energy : energies)
    EXPECT_NEAR(energy.stored, modulus * (gradients + stretches), tolerance);

  // The stresses of the gradient part are derivatives of the energy by F.
  const auto forces_without = network_memory(modulus, times);
  const auto stresses = [&](const FibreMemory &law)
  {
    RateForces sudden(*of.sheet, nullptr, &law);
    sudden.start(at_rest, 0., {});
    std::vector<BranchEnergy> unused;
    sudden.set_history(sudden.advanced(0., u, load_factor, unused));
    std::vector<Tensor<2, 2>> result(of.mesh.n_locally_owned_active_cells() * 9);
    sudden.add_stresses(u, u, {load_factor}, result);
    return result;
  };
  const auto with = stresses(memory()), without = stresses(forces_without);
  std::size_t point = 0;
  integrated(of,
             [&](const Point<2> &X)
             {
               for (unsigned int i = 0; i < 2 && point < with.size(); ++i)
                 for (unsigned int J = 0; J < 2; ++J)
                 {
                   Tensor<2, 2> up = F(X), down = F(X);
                   up[i][J] += 1e-5;
                   down[i][J] -= 1e-5;
                   EXPECT_NEAR(with[point][i][J] - without[point][i][J],
                               2. * modulus * (of_gradients(up) - of_gradients(down)) / 2e-5,
                               1e-6 * modulus * of_gradients(F(X)));
                 }
               ++point;
               return 0.;
             });

  // Held for a time in parts, and saved in between.
  const double parts[] = {1e-4, 3e-4, 2e-3};
  double passed = 0.;
  for (const double part : parts)
  {
    forces.set_history(forces.advanced(part, u, load_factor, energies));
    passed += part;
    memory_archive::Store store;
    memory_archive::Archive<false> out(store, "");
    forces.archive(out, u, load_factor);
    store = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, store);
    RateForces loaded(*of.sheet, nullptr, &memory());
    memory_archive::Archive<true> in(store, "");
    loaded.archive(in, u, load_factor);
    for (std::size_t law = 0; law < 2; ++law)
    {
      EXPECT_EQ(loaded.history()[law].overstress, forces.history()[law].overstress);
      EXPECT_EQ(loaded.history()[law].strain, forces.history()[law].strain);
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const double decay = std::exp(-2. * passed / times[i]);
    EXPECT_NEAR(energies[i].stored, decay * modulus * (gradients + stretches), tolerance);
    EXPECT_NEAR(energies[i].dissipated, (1. - decay) * modulus * (gradients + stretches), tolerance);
  }
}

// Nodal forces at a rough state, whose normal gradients jump, on a mesh with hanging nodes: those of a sudden change
// are derivatives of the stored energy, and their derivatives are the tangent, also while branches relax.
// theory-viscoelastic.md, eqs. (V.3) and (V.9).
TEST(GradientMemory, HasTheForcesOfTheLiftedGradients)
{
  BoundaryConditions conditions;
  conditions.normal_gradients = {{edge::right, constant(0.3, 0.2)}};
  const GradientSheet of(conditions);
  const Sheet &sheet = *of.sheet;
  const auto rough = [&](const double size, const double phase)
  {
    return nodal(sheet,
                 [=](const Point<2> &X)
                 {
                   return size * Tensor<1, 2>({std::sin(900. * (X[0] + 2. * X[1]) + phase),
                                               std::cos(1300. * (X[1] - X[0]) + phase)});
                 });
  };
  const auto sum = [&](const Sheet::Vector &u, const double share, const Sheet::Vector &v)
  {
    Sheet::Vector owned = sheet.make_owned(), other = sheet.make_owned(), result = sheet.make_ghosted();
    owned = u;
    other = v;
    owned.add(share, other);
    result = owned;
    return result;
  };
  const Sheet::Vector u = rough(2e-4, 0.), v = rough(1e-4, 1.), first = rough(2e-4, 2.);
  constexpr double load_factor = 0.8;
  Sheet::Vector direction = sheet.make_owned();
  direction = v;
  RateForces forces(sheet, nullptr, &memory());
  for (const double duration : {0., 3e-4})
  {
    forces.start(first, load_factor, {});
    const auto at = [&](const double share)
    {
      Sheet::Vector result = sheet.make_owned();
      forces.add_forces(duration, sum(u, share, v), v, {load_factor}, result, nullptr);
      return result;
    };
    constexpr double step = 1e-4;
    if (duration == 0.)
    {
      const auto energy = [&](const double share)
      {
        std::vector<BranchEnergy> energies;
        forces.advanced(0., sum(u, share, v), load_factor, energies);
        return energies[0].stored + energies[1].stored;
      };
      const double power = at(0.) * direction;
      EXPECT_NEAR((energy(step) - energy(-step)) / (2. * step), power, 1e-6 * std::abs(power));
    }
    Sheet::Matrix K;
    sheet.make_matrix(sheet.conformity_constraints(), K);
    forces.add_tangent(duration, u, v, {load_factor}, 0., sheet.conformity_constraints(), K);
    Sheet::Vector slope = sheet.make_owned(), difference = at(step);
    K.vmult(slope, direction);
    difference -= at(-step);
    difference *= 1. / (2. * step);
    for (const auto i : sheet.owned())
      if (sheet.conformity_constraints().is_constrained(i))
        slope(i) = difference(i) = 0.;
    slope.compress(dealii::VectorOperation::insert);
    difference.compress(dealii::VectorOperation::insert);
    difference -= slope;
    EXPECT_LT(difference.l2_norm(), 1e-6 * slope.l2_norm()) << duration;
  }
}

// The ledger of a sheet with a moving boundary and, on another edge, a normal gradient that moves: of second order in
// the time step.
TEST(GradientMemory, BalancesTheWorkOfAMovingBoundary)
{
  const auto imbalance = [](const double time_step)
  {
    const GradientSheet of;
    BoundaryConditions conditions;
    conditions.displacements = {{edge::left, affine(matrix(1., 0., 0., 1.3))}};
    conditions.normal_gradients = {{edge::right, constant(0.5, 0.2)}};
    DynamicSettings settings{time_step};
    settings.degree = 2;
    DynamicSolver solver(
      of.mesh, Constitution(of.law, of.gradient), conditions, {density, micro_length}, settings, nullptr,
      [](const double t) { return 0.5 - 0.5 * std::cos(2000. * t); }, &memory());
    solver.start();
    solver.run_until(1.6e-3);
    EXPECT_GT(solver.branch_energies()[0].dissipated, 0.01 * solver.ledger().work);
    EXPECT_GT(solver.branch_energies()[1].stored, 0.01 * solver.ledger().work);
    return solver.ledger().imbalance / solver.ledger().work;
  };
  const double coarse = imbalance(4e-5);
  const double fine = imbalance(2e-5);
  EXPECT_LT(std::abs(fine), 2e-3);
  EXPECT_GE(std::log2(std::abs(coarse / fine)), 1.8) << coarse << " " << fine;
}

TEST(GradientMemory, RefusesWhatHasNoLiftedGradients)
{
  const CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, rectangle(2, 2));
  const Sheet sheet(mesh, law, 2);
  EXPECT_THROW(RateForces(sheet, nullptr, &memory()), InvalidInput);
  std::vector<MaxwellFibres> families = memory().families();
  EXPECT_THROW(FibreMemory(families, spacing / 3.), InvalidMaterial);
  families.front().length = 0.;
  EXPECT_THROW(FibreMemory(families, micro_length), InvalidMaterial);
  EXPECT_NO_THROW(FibreMemory{families});

  const GradientSheet of;
  DynamicSolver solver(of.mesh, Constitution(of.law, of.gradient), {}, {density, micro_length}, DynamicSettings{1e-5},
                       nullptr, {}, &memory());
  solver.start();
  EXPECT_THROW(solver.release(0.), InvalidInput);
}
} // namespace gradient_memory_test
