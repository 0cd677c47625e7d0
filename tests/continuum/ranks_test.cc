// Comparison of several ranks with one rank: each rank solves the whole problem on its own communicator, then all solve
// it together. Motions: motion_archive_test.cc.
#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/field_writer.h"
#include "continuum/meshes.h"
#include "multigrid_cases.h"
#include "sheets.h"
#include "support/errors.h"

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace ranks_test
{

using namespace latcon;
using namespace sheets;
using continuum::StaticSettings;
using continuum::StaticSolver;
namespace edge = continuum::edge;

struct Answer
{
  double energy;
  std::map<dealii::types::boundary_id, Tensor<1, 2>> reactions;
  std::vector<continuum::PointState> states;
  continuum::DeterminantRange range;
};

void expect_same(const Answer &alone, const Answer &together)
{
  const double tolerance = 1e-10;
  EXPECT_NEAR(together.energy, alone.energy, tolerance * alone.energy);
  ASSERT_EQ(together.reactions.size(), alone.reactions.size());
  for (const auto &[boundary, force] : alone.reactions)
    EXPECT_NEAR((together.reactions.at(boundary) - force).norm(), 0., tolerance * force.norm());
  EXPECT_NEAR(together.range.smallest, alone.range.smallest, tolerance * alone.range.smallest);
  EXPECT_NEAR(together.range.largest, alone.range.largest, tolerance * alone.range.largest);
  for (std::size_t p = 0; p < alone.states.size(); ++p)
  {
    const auto &one = alone.states[p];
    const auto &all = together.states[p];
    EXPECT_NEAR((all.displacement - one.displacement).norm(), 0., tolerance * length);
    EXPECT_NEAR((all.F - one.F).norm(), 0., tolerance * one.F.norm());
    EXPECT_NEAR((all.P - one.P).norm(), 0., tolerance * one.P.norm());
    EXPECT_NEAR(all.energy_density, one.energy_density, tolerance * one.energy_density);
  }
}

// Gradient law on an adaptively refined notched sheet: face terms, hanging nodes and their constraints across ranks.
Answer adaptive_answer(const MPI_Comm communicator, const dealii::types::global_dof_index direct_limit)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  const continuum::LatticeGradient gradient = rubber_gradient(0.01);
  Mesh mesh(communicator);
  continuum::make_notched_rectangle(mesh, {length, height, 0.06, 1});
  const auto field = affine(matrix(1., 0.1, 0., 1.3));
  continuum::BoundaryConditions conditions{{continuum::edge::bottom, field}, {continuum::edge::top, field}};
  conditions.normal_gradients.push_back(
    {continuum::edge::top, std::make_shared<Field>([](const Point<2> &) { return Tensor<1, 2>(); })});
  conditions.body_force = continuum::BodyForce{std::make_shared<Field>(
                                                 [](const Point<2> &X) {
                                                   return Tensor<1, 2>({1e5 * X[1], 2e5});
                                                 }),
                                               0.};
  StaticSettings settings;
  settings.relative_tolerance = 1e-13;
  settings.linear.direct_limit = direct_limit;
  settings.linear.relative_tolerance = 1e-10;
  settings.linear.coarsest_size = 100;
  StaticSolver solver(mesh, continuum::Constitution(law, gradient), conditions, settings);
  solver.solve();
  for (unsigned int cycle = 0; cycle < 2; ++cycle)
  {
    solver.refine(mesh, 0.2);
    solver.equilibrate();
  }
  auto points = scattered_points(7, 5);
  points.emplace_back(length / 2, 0.);       // a vertex of the mesh
  points.emplace_back(length / 12, -0.0213); // on an edge between cells
  points.emplace_back(0., height / 2);       // a corner of the sheet
  const continuum::Sheet &sheet = solver.sheet();
  return {solver.total_energy(), solver.reactions(), sheet.evaluate(solver.displacement(), points),
          sheet.determinant_range(solver.displacement())};
}

struct LinearAnswer
{
  unsigned int iterations;
  std::vector<continuum::PointState> states;
};

// Tangent of a gradient law on an adaptive mesh, solved by conjugate gradients with multigrid. The matrix has single
// precision, the order in which its entries are summed is that of the ranks, and the rounding of 2^-24 is amplified by
// the ratio of the stiffnesses against short and long waves; measured 1e-6.
LinearAnswer linear_answer(const MPI_Comm communicator, const unsigned int degree)
{
  const multigrid_cases::HeldSheet problem(0.03 * length, degree, rectangle(6, 4), 3, 100, communicator);
  const continuum::Sheet &sheet = *problem.sheet;
  continuum::Sheet::Vector x = sheet.make_owned();
  LinearAnswer answer;
  answer.iterations =
    multigrid_cases::solve(*problem.multigrid, problem.K, x, multigrid_cases::body_force(sheet), 1e-12);
  sheet.homogeneous_constraints().distribute(x);
  // Scaled to a displacement within the domain of the law.
  x *= 1e-3 * length / x.linfty_norm();
  answer.states = sheet.evaluate(ghosted(sheet, x), scattered_points(7, 5));
  return answer;
}

unsigned int rank()
{
  return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
}
unsigned int n_ranks()
{
  return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
}

TEST(Ranks, AreAsManyAsTheTestSays)
{
  EXPECT_EQ(std::to_string(n_ranks()), std::getenv("LATCON_RANKS"));
}

TEST(Ranks, NeedTheSameMultigridIterationsForTheSameAnswer)
{
  for (const unsigned int degree : {2u, 3u})
  {
    const LinearAnswer alone = linear_answer(MPI_COMM_SELF, degree);
    const LinearAnswer together = linear_answer(MPI_COMM_WORLD, degree);
    EXPECT_NEAR(together.iterations, alone.iterations, 1.);
    for (std::size_t p = 0; p < alone.states.size(); ++p)
      EXPECT_NEAR((together.states[p].displacement - alone.states[p].displacement).norm(), 0., 1e-5 * 1e-3 * length);
  }
}

TEST(Ranks, SolveSheetsSmallerThanTheirNumber)
{
  // One cell: all ranks except one have no cells.
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(1, 1), MPI_COMM_WORLD);
  const Tensor<2, 2> F = matrix(2.3, 0.2, 0.1, 2.8);
  StaticSolver solver(mesh, law, on_all_edges(affine(F)));
  solver.solve();
  const double energy = law.energy(F) * length * height;
  EXPECT_NEAR(solver.total_energy(), energy, 1e-10 * energy);
  EXPECT_NEAR(solver.sheet().determinant_range(solver.displacement()).smallest, determinant(F), 1e-10);
}

TEST(Ranks, AllThrowWhatOneThrows)
{
  const unsigned int last = n_ranks() - 1;
  const auto fail_on_last = [&]
  {
    if (rank() == last)
      throw continuum::NonPhysicalState("rank " + std::to_string(last));
  };
  EXPECT_EQ(message_of<continuum::NonPhysicalState>([&] { continuum::run_collectively(MPI_COMM_WORLD, fail_on_last); }),
            "rank " + std::to_string(last));
  // The most severe failure is reported, regardless of its rank.
  const auto fail_differently = [&]
  {
    if (rank() == last)
      throw continuum::OutputFailed("no disk");
    throw continuum::NonPhysicalState("no matter");
  };
  EXPECT_THROW(continuum::run_collectively(MPI_COMM_WORLD, fail_differently), continuum::OutputFailed);
  const auto fail_of_input = [] { throw support::InputError("no number"); };
  EXPECT_THROW(continuum::run_collectively(MPI_COMM_WORLD, fail_of_input), support::InputError);
  EXPECT_NO_THROW(continuum::run_collectively(MPI_COMM_WORLD, [] {}));
}

TEST(Ranks, AllSeeANonPhysicalStateOnOneRank)
{
  // One cell in a corner of the sheet is inverted.
  const continuum::MooneyRivlin law = rubber_sheet();
  RectangleMesh mesh(rectangle(8, 8), MPI_COMM_WORLD);
  const continuum::Sheet sheet(mesh, law, 1);
  continuum::Sheet::Vector owned = sheet.make_owned();
  std::vector<dealii::types::global_dof_index> dofs(sheet.element().n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned() && cell->vertex(0).distance(Point<2>(0., -height / 2)) < 1e-12)
    {
      cell->get_dof_indices(dofs);
      owned(dofs[0]) = length;
    }
  owned.compress(dealii::VectorOperation::insert);
  const continuum::Sheet::Vector u = ghosted(sheet, owned);
  EXPECT_THROW(sheet.energy(u), continuum::NonPhysicalState);
  continuum::Sheet::Vector r = sheet.make_owned();
  continuum::Sheet::Vector magnitude = sheet.make_owned();
  EXPECT_THROW(sheet.residual(u, r, magnitude), continuum::NonPhysicalState);
  EXPECT_LT(sheet.determinant_range(u).smallest, 0.);

  // The solver halves its steps, fails, and throws on every rank.
  StaticSettings settings;
  settings.degree = 1;
  settings.smallest_load_step = 0.25;
  const auto corner = std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({X.distance(Point<2>(0., -height / 2)) < 1e-3 ? 10. * length : 0., 0.});
    });
  StaticSolver solver(mesh, law, on_all_edges(corner), settings);
  EXPECT_THROW(solver.solve(), continuum::SolverFailed);
}

TEST(Ranks, GiveTheSameGradientEquilibriumOnAnAdaptiveMesh)
{
  for (const dealii::types::global_dof_index direct_limit : {1000000, 0})
    expect_same(adaptive_answer(MPI_COMM_SELF, direct_limit), adaptive_answer(MPI_COMM_WORLD, direct_limit));
}

TEST(Ranks, WritePiecesThatVtkJoins)
{
  namespace fs = std::filesystem;
  // The same folder on every rank, named after the parent process, mpirun.
  const fs::path directory = fs::temp_directory_path() / ("latcon_ranks_" + std::to_string(::getppid()));
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(6, 4), MPI_COMM_WORLD);
  StaticSettings settings;
  settings.first_load_step = 1. / 3.;
  StaticSolver solver(mesh, law, on_all_edges(affine(matrix(2.3, 0.25, -0.1, 1.4))), settings);
  continuum::FieldWriter writer(MPI_COMM_WORLD, directory);
  writer.add_frame(0., solver.sheet(), solver.displacement());
  solver.solve([&](const double factor) { writer.add_frame(factor, solver.sheet(), solver.displacement()); });
  if (rank() == 0)
  {
    const std::string command = std::string(PYTHON) + " " + CHECK_FIELDS + " " + writer.collection().string() + " 3 24";
    EXPECT_EQ(std::system(command.c_str()), 0);
    fs::remove_all(directory);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_THROW(writer.add_frame(2., solver.sheet(), solver.displacement()), continuum::OutputFailed);
}

} // namespace ranks_test
