// Forces of dashpots and Maxwell branches in sheets, with their gradient part and without, on the ranks of the test
// program.
#include "continuum/errors.h"
#include "continuum/rate_forces.h"
#include "memory_archive.h"
#include "moving_sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

namespace rate_forces_test
{

using namespace moving_sheets;
using namespace latcon::continuum;

constexpr double micro_length = 0.012, spacing = micro_length / 0.6; // [m]
constexpr double modulus = 2e5;
const std::vector<double> times{2e-4, 3e-3};

// A mesh with hanging nodes, and laws with their gradient part or without.
class ForcesOfRates : public testing::TestWithParam<bool>
{
protected:
  ForcesOfRates() : mesh(MPI_COMM_WORLD)
  {
    make_rectangle(mesh, rectangle(2, 2));
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.5 * length && cell->center()[1] < 0.)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
    if (has_gradient)
      constitution.gradient = &gradient;
  }

  // Prescribes a normal gradient on the right edge of a sheet that can have one.
  BoundaryConditions with_normal_gradient(const std::shared_ptr<Field> &field) const
  {
    BoundaryConditions conditions;
    if (has_gradient)
      conditions.normal_gradients = {{edge::right, field}};
    return conditions;
  }

  // Sum over the quadrature points of all cells, in their order, of density(X) dX.
  template <class Density>
  double integrated(const Density &density) const
  {
    double sum = 0.;
    const dealii::QGauss<2> points(3);
    for (const auto &cell : mesh.active_cell_iterators())
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

  const bool has_gradient = GetParam();
  const CauchyBorn law = rubber_network();
  const LatticeGradient gradient = rubber_gradient(spacing);
  const FibreViscosity viscosity = network_viscosity(60., has_gradient ? micro_length : 0.);
  const FibreMemory memory = network_memory(modulus, times, has_gradient ? micro_length : 0.);
  Constitution constitution{law};
  Mesh mesh;
};

// A quadratic displacement, reached suddenly from an affine one and held: dissipation, energies and stresses are those
// of the laws at the points, overstresses decay with their relaxation times, and the history goes through an archive.
// There are no jumps, also at the edge with its prescribed normal gradient. theory-continuum.md, eq. (C.63); theory.md,
// eq. (L.31); theory-viscoelastic.md, eq. (V.9).
TEST_P(ForcesOfRates, RelaxInAHeldSheet)
{
  constexpr double rate = 40.;
  std::mt19937 generator(42);
  Tensor<3, 2> G = random_gradient(generator, length);
  const Tensor<2, 2> before = matrix(0.2, 0.1, 0.1, 0.3);
  Tensor<2, 2> stretch = before;
  for (unsigned int i = 0; i < 2; ++i)
  {
    G[i][0][0] = (i == 0 ? -0.4 : 0.2) / length;
    G[i][0][1] = G[i][1][0] = 0.;
    stretch[i][0] -= G[i][0][0] * length; // on the right edge the normal gradient is that before
  }
  const auto displacement_gradient = [&](const Point<2> &X)
  {
    Tensor<2, 2> sum = stretch;
    for (unsigned int i = 0; i < 2; ++i)
      sum[i] += G[i] * Tensor<1, 2>(X);
    return sum;
  };
  const auto displacement = [&](const Point<2> &X)
  {
    Tensor<1, 2> sum = stretch * Tensor<1, 2>(X);
    for (unsigned int i = 0; i < 2; ++i)
      sum[i] += 0.5 * (X * (G[i] * Tensor<1, 2>(X)));
    return sum;
  };
  const Sheet sheet(mesh, constitution, 2, with_normal_gradient(constant(before[0][0], before[1][0])));
  const auto u = nodal(sheet, displacement);
  const auto rest = nodal(sheet, [&](const Point<2> &X) { return before * Tensor<1, 2>(X); });
  const auto v = nodal(sheet, [&](const Point<2> &X) { return rate * (displacement(X) - before * Tensor<1, 2>(X)); });

  // The laws at X in the sudden change: stored energy, dissipated power, and stress.
  struct AtPoint
  {
    double stored, power;
    Tensor<2, 2> stress;
  };
  const auto at = [&](const Point<2> &X)
  {
    const Tensor<2, 2> H = displacement_gradient(X);
    const FieldDerivatives du = field_derivatives(identity + H, G);
    const FieldDerivatives dv = field_derivatives(identity + rate * (H - before), rate * G);
    PointIntegrand of_viscosity, of_memory;
    clear(of_viscosity, Order::first);
    clear(of_memory, Order::first);
    for (const Viscosity *part = &viscosity; part != nullptr; part = part->gradient())
      part->add_density(du, dv, Order::first, 0., of_viscosity);
    std::vector<double> stored(times.size());
    for (const FibreMemory *part = &memory; part != nullptr; part = part->gradient())
    {
      std::vector<double> relaxed(part->n_strains()), now(part->n_strains()), q(part->n_variables());
      part->strains(field_derivatives(identity + before), relaxed.data());
      part->strains(du, now.data());
      for (std::size_t number = 0; number < times.size(); ++number)
        part->set_sudden(number, relaxed.data(), now.data(), q.data());
      part->add_stored(q.data(), stored.data());
      part->add_density(part->step(0.), du, q.data(), Order::first, of_memory);
    }
    EXPECT_DOUBLE_EQ(stored[0], stored[1]);
    AtPoint result{stored[0], of_viscosity.value, {}};
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        result.stress[i][J] = of_viscosity.first[i][J] + of_memory.first[i][J];
    return result;
  };
  const double stored = integrated([&](const Point<2> &X) { return at(X).stored; });
  const double power = integrated([&](const Point<2> &X) { return at(X).power; });

  RateForces forces(sheet, &viscosity, &memory);
  forces.start(u, {u, u});
  std::vector<BranchEnergy> energies;
  forces.advanced(0., u, energies);
  for (const BranchEnergy &energy : energies)
    EXPECT_EQ(energy.stored, 0.);
  forces.start(rest, {});
  forces.set_history(forces.advanced(0., u, energies));
  for (const BranchEnergy &energy : energies)
    EXPECT_NEAR(energy.stored, stored, 1e-12 * stored);
  EXPECT_NEAR(forces.dissipation(u, v), power, 1e-12 * power);
  std::vector<Tensor<2, 2>> stresses(mesh.n_locally_owned_active_cells() * 9);
  forces.add_stresses(u, v, stresses);
  std::size_t point = 0;
  integrated(
    [&](const Point<2> &X)
    {
      const Tensor<2, 2> stress = at(X).stress;
      EXPECT_LT((stresses[point++] - stress).norm(), 1e-12 * stress.norm());
      return 0.;
    });

  // Held for a time in parts, and saved in between.
  double passed = 0.;
  for (const double part : {1e-4, 3e-4, 2e-3})
  {
    forces.set_history(forces.advanced(part, u, energies));
    passed += part;
    memory_archive::Store store;
    memory_archive::Archive<false> out(store, "");
    forces.archive(out, u);
    store = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, store);
    RateForces loaded(sheet, nullptr, &memory);
    memory_archive::Archive<true> in(store, "");
    loaded.archive(in, u);
    for (std::size_t law = 0; law < 2; ++law)
    {
      EXPECT_EQ(loaded.history()[law].overstress, forces.history()[law].overstress);
      EXPECT_EQ(loaded.history()[law].strain, forces.history()[law].strain);
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const double decay = std::exp(-2. * passed / times[i]);
    EXPECT_NEAR(energies[i].stored, decay * stored, 1e-12 * stored);
    EXPECT_NEAR(energies[i].dissipated, (1. - decay) * stored, 1e-12 * stored);
  }
}

// Nodal forces at a rough state, whose normal gradients jump: those of dashpots do the dissipated power, those of a
// sudden change of branches are derivatives of the stored energy, and their derivatives are the tangent, also while
// branches relax. theory-continuum.md, eqs. (C.40) and (C.63); theory-viscoelastic.md, eqs. (V.3) and (V.9).
TEST_P(ForcesOfRates, HaveAConsistentTangent)
{
  const Sheet sheet(mesh, constitution, 2, with_normal_gradient(constant(0.3, 0.2)));
  const auto rough = [&](const double size, const double phase)
  {
    return nodal(sheet,
                 [=](const Point<2> &X)
                 {
                   return size * Tensor<1, 2>({std::sin(900. * (X[0] + 2. * X[1]) + phase),
                                               std::cos(1300. * (X[1] - X[0]) + phase)});
                 });
  };
  const auto sum = [&](const Sheet::Vector &one, const double share, const Sheet::Vector &other)
  {
    Sheet::Vector total = owned(sheet, one), result = sheet.make_ghosted();
    total.add(share, owned(sheet, other));
    result = total;
    return result;
  };
  const Sheet::Vector u = rough(2e-4, 0.), v = rough(0.1, 1.), w = rough(1e-4, 3.);
  const Sheet::Vector direction = owned(sheet, w);
  constexpr double step = 1e-4, rate_by_displacement = 20.;
  RateForces forces(sheet, &viscosity, &memory);
  const RateForces of_dashpots(sheet, &viscosity, nullptr), of_branches(sheet, nullptr, &memory);
  for (const double duration : {0., 3e-4})
  {
    forces.start(rough(2e-4, 2.), {});
    const auto at = [&](const double share)
    {
      Sheet::Vector result = sheet.make_owned();
      forces.add_forces(duration, sum(u, share, w), sum(v, share * rate_by_displacement, w), result, nullptr);
      return result;
    };
    if (duration == 0.)
    {
      Sheet::Vector viscous = sheet.make_owned(), elastic = at(0.);
      of_dashpots.add_forces(0., u, v, viscous, nullptr);
      elastic -= viscous;
      const double power = viscous * owned(sheet, v);
      EXPECT_GT(power, 0.);
      EXPECT_NEAR(forces.dissipation(u, v), power, 1e-12 * power);
      const auto energy = [&](const double share)
      {
        std::vector<BranchEnergy> energies;
        forces.advanced(0., sum(u, share, w), energies);
        return energies[0].stored + energies[1].stored;
      };
      const double slope = elastic * direction;
      EXPECT_NEAR((energy(step) - energy(-step)) / (2. * step), slope, 1e-6 * std::abs(slope));
    }
    Sheet::Matrix K;
    sheet.make_matrix(sheet.conformity_constraints(), K);
    forces.add_tangent(duration, u, v, rate_by_displacement, sheet.conformity_constraints(), K);
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
    // Differences have relative errors of the square of the step over the size of a cell, and of round-off over the
    // step.
    EXPECT_LT(difference.l2_norm(), 1e-6 * slope.l2_norm()) << duration;
  }
}

// The ledger of a moving sheet is of second order in the time step.
TEST_P(ForcesOfRates, BalanceTheEnergyOfAMotion)
{
  BoundaryConditions conditions = with_normal_gradient(constant(0., 0.));
  conditions.displacements = {{edge::left, constant(0., 0.)}};
  const auto imbalance = [&](const double time_step)
  {
    DynamicSolver solver(mesh, constitution, conditions, {density, has_gradient ? micro_length : 0.},
                         quadratic(time_step), nullptr, &memory);
    start(solver, nullptr,
          std::make_shared<Field>(
            [](const Point<2> &X) {
              return Tensor<1, 2>({100. * X[0] * (2. * length - X[0]), 200. * X[0] * (2. * length - X[0])}) / length;
            }));
    const double energy = solver.ledger().kinetic;
    run_until(solver, 1.6e-3);
    EXPECT_GT(solver.branch_energies()[0].dissipated, 0.01 * energy);
    EXPECT_GT(solver.branch_energies()[1].stored, 0.01 * energy);
    return solver.ledger().imbalance / energy;
  };
  const double coarse = imbalance(4e-5);
  const double fine = imbalance(2e-5);
  EXPECT_LT(std::abs(fine), 2e-3);
  EXPECT_GE(std::log2(std::abs(coarse / fine)), 1.8) << coarse << " " << fine;
}

// A held sheet dissipates what its branches stored, and a step that fails leaves their history as it was.
TEST_P(ForcesOfRates, StayAsTheyWereAfterAStepThatFails)
{
  const RefusingNetwork refusing;
  constitution.local = &refusing;
  DynamicSolver solver(mesh, constitution, on_all_edges(constant(0., 0.)), {density}, quadratic(1e-4), nullptr,
                       &memory);
  const auto zero = solver.sheet().make_owned();
  const auto half = nodal(solver.sheet(), [](const Point<2> &X) { return -0.1 * Tensor<1, 2>(X); });
  EXPECT_THROW(solver.start(zero, zero, {half}), InvalidInput);
  solver.start(zero, zero, {half, zero});
  EXPECT_GT(solver.branch_energies()[0].stored, 0.);
  EXPECT_EQ(solver.branch_energies()[1].stored, 0.);
  solver.start(zero, zero, {half, half});
  // Each fibre pulls with a tenth of both moduli: virtual work of the reactions in a displacement X.
  double weights = 0.;
  for (const MaxwellFibres &fibres : memory.families())
    weights += fibres.weight;
  const auto position = nodal(solver.sheet(), [](const Point<2> &X) { return Tensor<1, 2>(X); });
  const double work = 0.2 * modulus * weights * length * height;
  EXPECT_NEAR(solver.reactions() * owned(solver.sheet(), position), work, 1e-12 * work);
  const double stored = solver.branch_energies()[0].stored + solver.branch_energies()[1].stored;
  for (int step = 0; step < 4; ++step)
    solver.step();
  const std::vector<BranchEnergy> before = solver.branch_energies();
  EXPECT_NEAR(solver.ledger().dissipated, stored - before[0].stored - before[1].stored, 1e-12 * stored);
  const auto reactions = solver.reactions();
  refusing.refusals = 1000000;
  EXPECT_THROW(solver.step(), SolverFailed);
  refusing.refusals = 0;
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(solver.branch_energies()[i].stored, before[i].stored);
    EXPECT_EQ(solver.branch_energies()[i].dissipated, before[i].dissipated);
  }
  auto difference = solver.reactions();
  difference -= reactions;
  EXPECT_EQ(difference.linfty_norm(), 0.);
  if (has_gradient)
  {
    EXPECT_THROW(solver.release(0.), InvalidInput);
  }
}

INSTANTIATE_TEST_SUITE_P(LocalAndGradient, ForcesOfRates, testing::Bool());

TEST(RateForces, RefuseGradientPartsWithoutLiftedGradients)
{
  const CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(2, 2));
  const Sheet sheet(mesh, law, 2);
  const FibreMemory memory = network_memory(modulus, times, micro_length);
  const FibreViscosity viscosity = network_viscosity(60., micro_length);
  EXPECT_THROW(RateForces(sheet, nullptr, &memory), InvalidInput);
  EXPECT_THROW(RateForces(sheet, &viscosity, nullptr), InvalidInput);
}

TEST(RateForces, ThrowWhereASheetIsFolded)
{
  const CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(2, 2));
  const Sheet sheet(mesh, law, 2);
  const FibreViscosity viscosity = network_viscosity(60.);
  const auto folded = nodal(sheet, [](const Point<2> &X) { return Tensor<1, 2>({-2. * X[0], 0.}); });
  auto forces = sheet.make_owned();
  EXPECT_THROW(RateForces(sheet, &viscosity, nullptr).add_forces(0., folded, folded, forces, nullptr),
               NonPhysicalState);
}

} // namespace rate_forces_test
