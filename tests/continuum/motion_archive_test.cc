// Saving and resuming of motions, on the ranks of the test program, and comparison with one rank.
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "memory_archive.h"
#include "moving_sheets.h"
#include "multigrid_cases.h"
#include "support/largest_error.h"

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <boost/serialization/map.hpp>

#include <optional>
#include <set>

namespace motion_archive_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::DynamicSolver;
using Rule = continuum::NewmarkParameters;
using memory_archive::load;
using memory_archive::Store;
using memory_archive::stored;
namespace edge = continuum::edge;

// Moving sheet with hanging nodes and all laws and conditions that the linear solver supports, solved by conjugate
// gradients or, with dashpots and Maxwell branches, by GMRES.
template <bool has_dashpots>
class MultigridMotion
{
public:
  explicit MultigridMotion(const MPI_Comm communicator) : mesh_(communicator)
  {
    continuum::make_rectangle(mesh_, rectangle(6, 4));
    multigrid_cases::refine_towards(mesh_, Point<2>(0.4 * length, 0.003), 2, length / 3.);
    continuum::BoundaryConditions conditions;
    conditions.displacements = {{edge::left, constant(0.01, 0.02)}};
    conditions.tractions = {{edge::right, constant(3e5, 1e5)}};
    conditions.normal_gradients = {{edge::top, constant(0.3, 0.2)}};
    continuum::DynamicSettings settings =
      quadratic(4e-4, has_dashpots ? Rule::generalised_alpha(0.8) : Rule::average_acceleration());
    settings.linear.direct_limit = 0;
    settings.linear.coarsest_size = 100;
    settings.linear.rebuild_ratio = 1.1; // so that some but not all of the steps rebuild it
    solver_ = std::make_unique<DynamicSolver>(mesh_, continuum::Constitution(law_, gradient_), conditions,
                                              continuum::Inertia{density, 0.01}, settings,
                                              has_dashpots ? &viscosity_ : nullptr, has_dashpots ? &memory_ : nullptr);
  }

  void start()
  {
    moving_sheets::start(*solver_, constant(0.01, 0.02),
                         std::make_shared<Field>(
                           [](const Point<2> &X) {
                             return Tensor<1, 2>({20. * std::sin(2. * pi * X[1] / height), 30. * X[0] / length});
                           }));
  }
  DynamicSolver &solver() { return *solver_; }

private:
  const continuum::CauchyBorn law_ = rubber_network();
  const continuum::IsotropicGradient gradient_{5e5, 0.01};
  const continuum::FibreViscosity viscosity_ = network_viscosity(50., 0.01);
  const continuum::FibreMemory memory_ = network_memory(1e5, {5e-4, 4e-3}, 0.01);
  Mesh mesh_;
  std::unique_ptr<DynamicSolver> solver_;
};

bool is_first_rank()
{
  return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
}

template <class T>
T value(const Store &store, const std::string &name)
{
  T result;
  std::memcpy(&result, store.at(name).data(), sizeof(T));
  return result;
}

std::vector<std::string> differing(const Store &one, const Store &two)
{
  std::vector<std::string> names;
  for (const auto &[name, bytes] : one)
    if (two.count(name) == 0 || two.at(name) != bytes)
      names.push_back(name);
  EXPECT_EQ(one.size(), two.size());
  return names;
}

constexpr unsigned int n_steps = 10;

// Returns the states at the start and after each step of an uninterrupted motion.
template <class M>
std::vector<Store> undisturbed()
{
  M motion(MPI_COMM_WORLD);
  motion.start();
  std::vector<Store> states = {stored(motion.solver())};
  while (states.size() <= n_steps)
  {
    motion.solver().step();
    states.push_back(stored(motion.solver()));
  }
  return states;
}

// Communicator of the first `n` ranks; null on other ranks.
class FirstRanks
{
public:
  explicit FirstRanks(const int n)
  {
    const int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    MPI_Comm_split(MPI_COMM_WORLD, rank < n ? 0 : MPI_UNDEFINED, rank, &communicator_);
  }
  ~FirstRanks()
  {
    if (*this)
      MPI_Comm_free(&communicator_);
  }
  explicit operator bool() const { return communicator_ != MPI_COMM_NULL; }
  MPI_Comm communicator() const { return communicator_; }

private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
};

// Field on a mesh with coarse cells of different orientations, some of them refined.
struct SheetWithHole
{
  explicit SheetWithHole(const MPI_Comm communicator) : mesh(communicator)
  {
    continuum::make_rectangle_with_hole(mesh, {length, height, 0.02, 1});
    multigrid_cases::refine_towards(mesh, Point<2>(0.6 * length, 0.02), 2, length / 4.);
    sheet = std::make_unique<continuum::Sheet>(mesh, law, 3);
  }

  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh;
  std::unique_ptr<continuum::Sheet> sheet;
};

template <class M>
void expect_same_bits_with_kept_multigrid()
{
  const std::vector<Store> states = undisturbed<M>();
  // Saved with an up-to-date multigrid, with one reused for several steps, and with a stale one.
  const auto set_ups = [&](const unsigned int at) { return value<unsigned int>(states[at], "linear_solver/set_ups"); };
  unsigned int n_keeping = 0;
  for (unsigned int at = 1; at <= n_steps; ++at)
    n_keeping += set_ups(at) == set_ups(at - 1);
  EXPECT_GT(n_keeping, 0u);
  EXPECT_GT(set_ups(n_steps), set_ups(0));
  for (const auto &[at, until] : {std::pair(0u, 2u), std::pair(5u, n_steps), std::pair(9u, n_steps)})
  {
    M motion(MPI_COMM_WORLD);
    load(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, states[at]), motion.solver());
    EXPECT_EQ(motion.solver().time(), value<double>(states[at], "time"));
    for (unsigned int step = at; step < until; ++step)
      motion.solver().step();
    const Store end = stored(motion.solver());
    if (!is_first_rank())
      continue;
    EXPECT_EQ(differing(end, states[until]), std::vector<std::string>()) << "resumed after step " << at;
  }
}

TEST(MotionArchive, GoesOnWithTheSameBitsWithAMultigridThatIsKept)
{
  expect_same_bits_with_kept_multigrid<MultigridMotion<false>>();
}

TEST(MotionArchive, GoesOnWithTheSameBitsWithBranchesAndAMultigridThatIsKept)
{
  expect_same_bits_with_kept_multigrid<MultigridMotion<true>>();
}

// State of a motion after another step. On the first rank it has all values.
struct End
{
  explicit End(DynamicSolver &solver)
  {
    solver.step();
    store = stored(solver);
    momentum = moving_sheets::momentum(solver);
  }
  std::vector<double> values(const std::string &name) const
  {
    std::vector<double> result(store.at(name).size() / sizeof(double));
    std::memcpy(result.data(), store.at(name).data(), store.at(name).size());
    return result;
  }

  Store store;
  Tensor<1, 2> momentum;
};

// Up to round-off in sums of another order, and conjugate gradients with a tolerance of 1e-8.
void expect_same(const End &found, const End &expected)
{
  const double energy =
    value<double>(expected.store, "ledger/stored") + value<double>(expected.store, "ledger/kinetic");
  for (const std::string name : {"stored", "kinetic", "micro_kinetic", "dissipated", "work"})
    EXPECT_NEAR(found.values("ledger/" + name)[0], expected.values("ledger/" + name)[0], 1e-9 * energy) << name;
  EXPECT_NEAR((found.momentum - expected.momentum).norm(), 0., 1e-9 * expected.momentum.norm());
  for (const std::string name : {"displacement", "velocity"})
  {
    const std::vector<double> x = found.values(name), y = expected.values(name);
    ASSERT_EQ(x.size(), y.size());
    support::LargestError difference, largest;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      difference.add(std::abs(x[i] - y[i]));
      largest.add(std::abs(y[i]));
    }
    EXPECT_LT(difference.error(), 1e-8 * largest.error()) << name;
  }
}

// A motion is the same on one rank as on all, and each number of ranks continues from the checkpoint of the other.
TEST(MotionArchive, IsTakenUpByAnyNumberOfRanksWithGmres)
{
  using M = MultigridMotion<true>;
  const std::set<int> numbers{1, static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))};
  std::optional<End> alone;
  for (const int writers : numbers)
  {
    const FirstRanks writing(writers);
    Store at_stop;
    std::optional<End> end;
    if (writing)
    {
      M motion(writing.communicator());
      motion.start();
      for (unsigned int step = 0; step < 4; ++step)
        motion.solver().step();
      at_stop = stored(motion.solver());
      end.emplace(motion.solver());
    }
    if (!alone)
      alone = end;
    if (is_first_rank())
      expect_same(*end, *alone);
    at_stop = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, at_stop);
    for (const int readers : numbers)
    {
      const FirstRanks reading(readers);
      if (!reading)
        continue;
      M motion(reading.communicator());
      load(at_stop, motion.solver());
      const Store again = stored(motion.solver());
      const End after(motion.solver());
      if (!is_first_rank())
        continue;
      EXPECT_EQ(differing(again, at_stop), std::vector<std::string>()) << writers << " to " << readers;
      expect_same(after, *end);
    }
  }
}

TEST(MotionArchive, PutsNodalValuesInTheirPlacesOnAnyNumberOfRanks)
{
  using continuum::NodalOrder;
  const auto field = [](const Point<2> &X, const unsigned int component)
  { return std::sin(40. * X[0] + 3. * component) + 7. * X[1]; };
  const SheetWithHole whole(MPI_COMM_SELF);
  continuum::Sheet::Vector u = whole.sheet->make_owned();
  whole.sheet->for_each_owned_dof([&](const auto dof, const unsigned int component, const Point<2> &X)
                                  { u(dof) = field(X, component); });
  const std::vector<double> values = NodalOrder(*whole.sheet).gather(u);

  const SheetWithHole shared(MPI_COMM_WORLD);
  continuum::Sheet::Vector x = shared.sheet->make_ghosted();
  const NodalOrder order(*shared.sheet);
  order.scatter(values, x);
  std::vector<dealii::types::global_dof_index> dofs(shared.sheet->element().n_dofs_per_cell());
  for (const auto &cell : shared.sheet->dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      cell->get_dof_indices(dofs);
      for (unsigned int a = 0; a < dofs.size(); ++a)
      {
        const Point<2> X =
          shared.sheet->mapping().transform_unit_to_real_cell(cell, shared.sheet->element().unit_support_point(a));
        // The position of a node may be computed from another of its cells, with other rounding errors.
        ASSERT_NEAR(x(dofs[a]), field(X, shared.sheet->element().system_to_component_index(a).first), 1e-13);
      }
    }
  EXPECT_EQ(order.gather(x), is_first_rank() ? values : std::vector<double>());
  EXPECT_THROW(order.scatter(std::vector<double>(values.size() - 1), x), continuum::InvalidInput);
}

} // namespace motion_archive_test
