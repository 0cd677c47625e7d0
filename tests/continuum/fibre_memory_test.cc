// Maxwell branches of a network: updates, energies, and their forces in a moving sheet.
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/fibre_memory.h"
#include "continuum/meshes.h"
#include "continuum/rate_forces.h"
#include "moving_sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <set>
#include <vector>

namespace fibre_memory_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::BranchEnergy;
using continuum::DynamicSolver;
using continuum::FibreMemory;
using continuum::MaxwellFibres;
using continuum::RateForces;
namespace edge = continuum::edge;

const double epsilon = std::numeric_limits<double>::epsilon();

// Two families, the second of which has branches of its own.
FibreMemory mixed_branches()
{
  return FibreMemory({{Tensor<1, 2>({0.6, 0.8}), 1.1, {{2e5, 1e-3}, {1e5, 2e-2}}, 0},
                      {Tensor<1, 2>({-0.28, 0.96}), 0.4, {{3e5, 5e-3}}, 2}});
}

std::vector<double> advanced(const FibreMemory &law, const double duration, const std::vector<double> &before,
                             const std::vector<double> &now, std::vector<double> q)
{
  law.advance(law.step(duration), before.data(), now.data(), q.data());
  return q;
}

std::vector<double> random_overstress(std::mt19937 &generator)
{
  std::uniform_real_distribution<double> overstress(-1e5, 1e5);
  return {overstress(generator), overstress(generator), overstress(generator)};
}

// theory-viscoelastic.md, eq. (V.2), with each overstress on a ramp from its differential equation.
TEST(FibreMemory, FollowsARampExactly)
{
  const FibreMemory law = mixed_branches();
  const std::vector<double> before{1.2, 0.9};
  const std::vector<double> now{1.5, 0.8};
  const std::vector<double> q0{3e4, -2e4, 1e4};
  const double moduli[] = {2e5, 1e5, 3e5};
  const double times[] = {1e-3, 2e-2, 5e-3};
  for (const double h : {1e-9, 1e-4, 1e-2, 1.})
  {
    const std::vector<double> q = advanced(law, h, before, now, q0);
    for (std::size_t i = 0; i < 3; ++i)
    {
      const double rate = (i < 2 ? 0.3 : -0.1) / h;
      const double exact = q0[i] * std::exp(-h / times[i]) - moduli[i] * times[i] * rate * std::expm1(-h / times[i]);
      EXPECT_NEAR(q[i], exact, 20. * epsilon * 1e5) << h;
    }
  }
  const std::vector<double> sudden = advanced(law, 0., before, now, q0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(sudden[i], q0[i] + moduli[i] * (i < 2 ? 0.3 : -0.1), 20. * epsilon * 1e5);
}

// theory-viscoelastic.md, eq. (V.7): modulus of the update for a wave e^(st), and its order.
TEST(FibreMemory, HasAModulusOfSecondOrder)
{
  using Complex = std::complex<double>;
  constexpr double modulus = 2e5;
  constexpr double time = 1e-3;
  const FibreMemory law({{Tensor<1, 2>({1., 0.}), 1., {{modulus, time}}, 0}});
  const Complex s(-120., 900.);
  const auto difference = [&](const double h)
  {
    const auto of_branch = law.step(h).coefficients.front();
    const Complex z = std::exp(s * h);
    const Complex found = of_branch.gain * (z - 1.) / (z - of_branch.decay);
    const double x = h / time;
    EXPECT_LT(
      std::abs(found / (modulus * 2. / x * std::sinh(0.5 * x) * std::sinh(0.5 * s * h) / std::sinh(0.5 * (x + s * h))) -
               1.),
      1e-12);
    return std::abs(found * (1. + s * time) / (modulus * s * time) - 1. + x * s * h / 12.);
  };
  EXPECT_NEAR(std::log2(difference(4e-4) / difference(2e-4)), 4., 0.1);
}

// theory-viscoelastic.md, eqs. (V.4) and (V.5): what the branches store and dissipate is the work done on them, here
// integrated by Gauss quadrature over parts of the ramp; and the dissipation of two halves is that of the whole.
TEST(FibreMemory, StoresAndDissipatesTheWorkDone)
{
  const FibreMemory law = mixed_branches();
  std::mt19937 generator(31);
  const std::vector<double> l0{1.2, 0.9};
  for (const double h : {1e-7, 1e-5, 3e-4, 9e-4, 1.1e-3, 4e-3, 1.9e-2, 2.1e-2})
  {
    const std::vector<double> q0 = random_overstress(generator);
    const std::vector<double> l1{1.5, 0.8};
    const auto at = [&](const double share) {
      return std::vector<double>{l0[0] + share * (l1[0] - l0[0]), l0[1] + share * (l1[1] - l0[1])};
    };
    std::vector<double> dissipated(3, 0.);
    std::vector<double> in_halves(3, 0.);
    std::vector<double> before(3, 0.);
    std::vector<double> after(3, 0.);
    law.add_dissipated(law.step(h), l0.data(), l1.data(), q0.data(), dissipated.data());
    const std::vector<double> middle = advanced(law, 0.5 * h, l0, at(0.5), q0);
    law.add_dissipated(law.step(0.5 * h), l0.data(), at(0.5).data(), q0.data(), in_halves.data());
    law.add_dissipated(law.step(0.5 * h), at(0.5).data(), l1.data(), middle.data(), in_halves.data());
    law.add_stored(q0.data(), before.data());
    law.add_stored(advanced(law, h, l0, l1, q0).data(), after.data());
    // 40 relaxation times at most in 400 parts: the quadrature is exact to round-off.
    double work[] = {0., 0., 0.};
    const dealii::QGauss<1> points(6);
    constexpr int parts = 400;
    for (int part = 0; part < parts; ++part)
      for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double share = (part + points.point(p)[0]) / parts;
        const std::vector<double> q = advanced(law, share * h, l0, at(share), q0);
        for (std::size_t i = 0; i < 3; ++i)
          work[i] += points.weight(p) / parts * q[i] * (i < 2 ? 1.1 * 0.3 : 0.4 * -0.1);
      }
    for (std::size_t i = 0; i < 3; ++i)
    {
      const double scale = before[i] + after[i] + std::abs(work[i]);
      EXPECT_GE(dissipated[i], 0.);
      EXPECT_NEAR(dissipated[i], in_halves[i], 100. * epsilon * scale) << h << ", branch " << i;
      EXPECT_NEAR(after[i] - before[i] + dissipated[i], work[i], 3000. * epsilon * scale) << h << ", branch " << i;
    }
  }
}

TEST(FibreMemory, RefusesInvalidFamilies)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MaxwellFibres valid{Tensor<1, 2>({1., 0.}), 0.5, {{1e5, 1e-3}}, 0};
  EXPECT_NO_THROW(FibreMemory({valid}));
  EXPECT_THROW(FibreMemory({}), continuum::InvalidMaterial);
  for (const double bad : {0., -1., nan, std::numeric_limits<double>::infinity()})
  {
    MaxwellFibres fibres = valid;
    fibres.weight = bad;
    EXPECT_THROW(FibreMemory({fibres}), continuum::InvalidMaterial);
    fibres = valid;
    fibres.branches[0].modulus = bad;
    EXPECT_THROW(FibreMemory({fibres}), continuum::InvalidMaterial);
    fibres = valid;
    fibres.branches[0].relaxation_time = bad;
    EXPECT_THROW(FibreMemory({fibres}), continuum::InvalidMaterial);
    fibres = valid;
    fibres.direction[1] = bad == 0. ? 1. : bad;
    EXPECT_THROW(FibreMemory({fibres}), continuum::InvalidMaterial);
  }
  MaxwellFibres fibres = valid;
  fibres.branches.clear();
  EXPECT_THROW(FibreMemory({fibres}), continuum::InvalidMaterial);
  std::vector<double> l(1);
  EXPECT_THROW(FibreMemory({valid}).strains(continuum::field_derivatives(matrix(-1., 0., 0., 1.)), l.data()),
               continuum::NonPhysicalState);
}

// Sheet held at its whole boundary, whose strain follows a load factor.
class HeldSheet
{
public:
  HeldSheet(const double time_step, DynamicSolver::LoadFactor load_factor)
    : law_(rubber_network()), memory_(network_memory(2e5, {2e-4, 3e-3})), mesh_(MPI_COMM_WORLD)
  {
    continuum::make_rectangle(mesh_, {length, height, 3, 2, false, false});
    continuum::BoundaryConditions conditions;
    const auto strained = std::make_shared<Field>([](const Point<2> &X) { return stretch() * Tensor<1, 2>(X); });
    for (const auto id : {edge::left, edge::right, edge::bottom, edge::top})
      conditions.displacements.push_back({id, strained});
    continuum::DynamicSettings settings{time_step};
    settings.degree = 2;
    solver_ =
      std::make_unique<DynamicSolver>(mesh_, continuum::Constitution(law_), conditions, continuum::Inertia{density},
                                      settings, nullptr, std::move(load_factor), &memory_);
  }

  static Tensor<2, 2> stretch() { return matrix(0.3, 0.1, 0., 0.5); }
  const FibreMemory &memory() const { return memory_; }
  DynamicSolver &solver() { return *solver_; }

private:
  const continuum::CauchyBorn law_;
  const FibreMemory memory_;
  Mesh mesh_;
  std::unique_ptr<DynamicSolver> solver_;
};

// A sheet that is strained suddenly and held: closed form of theory.md, eq. (L.31). The energies balance to round-off.
TEST(RateForces, RelaxInAHeldSheet)
{
  constexpr double h = 1e-4;
  constexpr int n_steps = 30;
  HeldSheet held(h, DynamicSolver::LoadFactor());
  DynamicSolver &solver = held.solver();
  const auto u = nodal(solver.sheet(), [](const Point<2> &X) { return HeldSheet::stretch() * Tensor<1, 2>(X); });
  const auto zero = solver.sheet().make_owned();
  EXPECT_THROW(solver.start(u, zero, 0., {zero}), continuum::InvalidInput);
  solver.start(u, zero, 0., {zero, zero});
  const std::vector<BranchEnergy> first = solver.branch_energies();
  const double stored = first[0].stored + first[1].stored;
  double expected[] = {0., 0.};
  const Tensor<2, 2> F = identity + HeldSheet::stretch();
  for (const MaxwellFibres &fibres : held.memory().families())
    for (std::size_t i = 0; i < 2; ++i)
      expected[i] += length * height * fibres.weight * 0.5 * fibres.branches[i].modulus *
                     std::pow((F * fibres.direction).norm() - 1., 2);
  for (int step = 0; step < n_steps; ++step)
    solver.step();
  const double times[] = {2e-4, 3e-3};
  for (std::size_t i = 0; i < 2; ++i)
  {
    // Updates round a few times each, sums over 54 quadrature points as often.
    const double tolerance = (4. * n_steps + 100.) * epsilon * expected[i];
    EXPECT_NEAR(first[i].stored, expected[i], tolerance);
    EXPECT_EQ(first[i].dissipated, 0.);
    const double decay = std::exp(-2. * n_steps * h / times[i]);
    EXPECT_NEAR(solver.branch_energies()[i].stored, decay * expected[i], tolerance);
    EXPECT_NEAR(solver.branch_energies()[i].dissipated, (1. - decay) * expected[i], tolerance);
  }
  EXPECT_NEAR(solver.ledger().dissipated,
              stored - solver.branch_energies()[0].stored - solver.branch_energies()[1].stored,
              1000. * epsilon * stored);
  EXPECT_NEAR(solver.ledger().imbalance, 0., 1000. * epsilon * solver.ledger().stored);
  // The moment of the reactions is the integral of P.
  Tensor<2, 2> P = rubber_network().first_piola_stress(F);
  for (const MaxwellFibres &fibres : held.memory().families())
    for (std::size_t i = 0; i < 2; ++i)
    {
      const Tensor<1, 2> f = F * fibres.direction;
      P += fibres.weight * fibres.branches[i].modulus * (f.norm() - 1.) * std::exp(-n_steps * h / times[i]) / f.norm() *
           outer_product(f, fibres.direction);
    }
  Tensor<2, 2> moment;
  const auto reactions = solver.reactions();
  std::set<dealii::types::global_dof_index> seen;
  solver.sheet().for_each_owned_dof(
    [&](const auto dof, const unsigned int i, const Point<2> &X)
    {
      if (seen.insert(dof).second)
        for (unsigned int J = 0; J < 2; ++J)
          moment[i][J] += reactions(dof) * X[J];
    });
  moment = dealii::Utilities::MPI::sum(moment, MPI_COMM_WORLD);
  EXPECT_NEAR((moment / (length * height) - P).norm(), 0., 1e-12 * P.norm());
}

// The derivative of the nodal forces, between updates and after them. theory-viscoelastic.md, eqs. (V.1) and (V.3).
TEST(RateForces, HaveAConsistentTangent)
{
  HeldSheet held(1e-4, DynamicSolver::LoadFactor());
  const continuum::Sheet &sheet = held.solver().sheet();
  RateForces forces(sheet, nullptr, &held.memory());
  forces.start(nodal(sheet, [](const Point<2> &X) { return 0.2 * Tensor<1, 2>(X); }), 1.,
               {sheet.make_ghosted(), nodal(sheet,
                                            [](const Point<2> &X) {
                                              return Tensor<1, 2>({0.3 * X[1], 0.});
                                            })});
  constexpr double duration = 1e-4;
  const auto u_of = [&](const double share)
  {
    return nodal(sheet,
                 [=](const Point<2> &X)
                 {
                   return Tensor<1, 2>({0.4 * X[0] + share * 0.01 * std::sin(40. * X[1]),
                                        0.3 * X[1] + share * 0.2 * X[0] * X[1] / length});
                 });
  };
  const auto at = [&](const double share)
  {
    auto result = sheet.make_owned();
    forces.add_forces(duration, u_of(share), u_of(share), {}, result, nullptr);
    return result;
  };
  continuum::Sheet::Matrix matrix;
  sheet.make_matrix(sheet.conformity_constraints(), matrix);
  forces.add_tangent(duration, u_of(0.), u_of(0.), {}, 0., sheet.conformity_constraints(), matrix);
  auto direction = owned(sheet, u_of(1.));
  direction -= owned(sheet, u_of(0.));
  auto slope = sheet.make_owned();
  matrix.vmult(slope, direction);
  const auto start = at(0.);
  const auto remainder = [&](const double share)
  {
    auto difference = at(share);
    difference -= start;
    difference.add(-share, slope);
    return difference.l2_norm();
  };
  EXPECT_GE(std::log2(remainder(std::ldexp(1., -4)) / remainder(std::ldexp(1., -7))) / 3., 1.9);
}

// The ledger of a sheet that is strained through its boundary: of second order in the time step.
TEST(RateForces, BalanceTheWorkOfAMovingBoundary)
{
  const auto imbalance = [](const double time_step)
  {
    HeldSheet held(time_step, [](const double t) { return 0.5 - 0.5 * std::cos(2000. * t); });
    held.solver().start();
    held.solver().run_until(1.6e-3);
    const continuum::EnergyLedger &ledger = held.solver().ledger();
    EXPECT_GT(held.solver().branch_energies()[0].dissipated, 0.01 * ledger.work);
    EXPECT_GT(held.solver().branch_energies()[1].stored, 0.01 * ledger.work);
    return ledger.imbalance / ledger.work;
  };
  const double coarse = imbalance(4e-5);
  const double fine = imbalance(2e-5);
  EXPECT_LT(std::abs(fine), 1e-3);
  EXPECT_GE(std::log2(std::abs(coarse / fine)), 1.8) << coarse << " " << fine;
}

// A step that fails leaves the history as it was.
TEST(RateForces, StayAsTheyWereAfterAStepThatFails)
{
  HeldSheet held(1e-4, [](const double t) { return t < 4.5e-4 ? 0. : -2.5; });
  DynamicSolver &solver = held.solver();
  const auto zero = solver.sheet().make_owned();
  const auto half = nodal(solver.sheet(), [](const Point<2> &X) { return -0.1 * Tensor<1, 2>(X); });
  solver.start(zero, zero, 0., {half, half});
  for (int step = 0; step < 4; ++step)
    solver.step();
  const std::vector<BranchEnergy> before = solver.branch_energies();
  const auto reactions = solver.reactions();
  EXPECT_THROW(solver.step(), continuum::SolverFailed);
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(solver.branch_energies()[i].stored, before[i].stored);
    EXPECT_EQ(solver.branch_energies()[i].dissipated, before[i].dissipated);
  }
  auto difference = solver.reactions();
  difference -= reactions;
  EXPECT_EQ(difference.linfty_norm(), 0.);
}

} // namespace fibre_memory_test
