// Edges that open during a motion, and planes of symmetry of sheets with a gradient energy.
#include "continuum/errors.h"
#include "moving_sheets.h"
#include "support/largest_error.h"

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <cmath>

namespace release_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::BoundaryConditions;
using continuum::Constitution;
using continuum::DynamicSettings;
using continuum::DynamicSolver;
using continuum::StaticSettings;
using continuum::StaticSolver;
namespace edge = continuum::edge;

constexpr dealii::types::boundary_id opened = 10;

// Moves the faces of the lower edge left of X to the boundary `opened`.
void open(Mesh &mesh, const double X)
{
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int face : cell->face_indices())
      if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == edge::bottom &&
          cell->face(face)->center()[0] < X)
        cell->face(face)->set_boundary_id(opened);
}

// Sheet held at the top and, in y only, at the bottom.
struct Pulled
{
  continuum::CauchyBorn law = rubber_network();
  continuum::IsotropicGradient gradient{5e5, 0.05};
  continuum::FibreViscosity viscosity = network_viscosity(200.);
  Tensor<2, 2> F = matrix(1.3, 0., 0., 1.5);

  BoundaryConditions conditions() const
  {
    BoundaryConditions all;
    for (const auto side : {edge::left, edge::right, edge::top})
      all.displacements.push_back({side, affine(F)});
    all.displacements.push_back({edge::bottom, affine(F), dealii::ComponentMask(std::vector<bool>{false, true})});
    return all;
  }

  std::unique_ptr<DynamicSolver> started(const Mesh &mesh, const double time_step) const
  {
    DynamicSettings settings = quadratic(time_step);
    auto solver = std::make_unique<DynamicSolver>(mesh, Constitution(law), conditions(), continuum::Inertia{density},
                                                  settings, &viscosity);
    start(*solver, affine(F));
    return solver;
  }
};

// The reaction at a released node acts at full strength at the release, and is zero after the given time.
TEST(Release, LetsNodesGoSmoothly)
{
  const Pulled problem;
  constexpr double duration = 1e-3;
  const auto released = [&](const unsigned int n)
  {
    RectangleMesh mesh(rectangle(4, 4));
    const auto solver = problem.started(mesh, duration / n);
    open(mesh, 0.5 * length);
    solver->release(duration);
    run_until(*solver, 2. * duration);
    const double work = solver->ledger().released;
    EXPECT_NEAR(solver->ledger().imbalance, 0., 2e-2 * work);
    EXPECT_NEAR(solver->ledger().work, -work, 1e-12 * std::abs(work)); // the held edge does not move
    return work;
  };
  const double coarse = released(10), middle = released(20), fine = released(40);
  EXPECT_GT(fine, 0.); // the edge was pulled shut
  // Second order in the time step: the forces do not jump.
  EXPECT_NEAR((coarse - middle) / (middle - fine), 4., 1.2);
}

// A long time after the release, an edge is at the equilibrium position of an edge that was never held.
TEST(Release, EndsWithAFreeEdge)
{
  const Pulled problem;
  RectangleMesh mesh(rectangle(4, 4));
  const auto solver = problem.started(mesh, 2e-3);
  open(mesh, 0.5 * length);
  solver->release(4e-3);
  run_until(*solver, 0.6);
  StaticSettings settings;
  settings.degree = 2;
  StaticSolver at_rest(mesh, Constitution(problem.law), problem.conditions(), settings);
  at_rest.solve();
  auto difference = owned(solver->sheet(), solver->displacement());
  const auto exact = owned(at_rest.sheet(), at_rest.displacement());
  difference -= exact;
  EXPECT_LT(difference.linfty_norm(), 1e-4 * exact.linfty_norm());
}

TEST(Release, RefusesWhatItCannotDo)
{
  const Pulled problem;
  RectangleMesh mesh(rectangle(4, 4));
  DynamicSettings settings = quadratic(1e-3);
  DynamicSolver not_started(mesh, Constitution(problem.law), problem.conditions(), continuum::Inertia{density},
                            settings);
  EXPECT_THROW(not_started.release(1e-3), continuum::InvalidInput);
  const auto solver = problem.started(mesh, 1e-3);
  EXPECT_THROW(solver->release(-1.), continuum::InvalidInput);
  EXPECT_THROW(solver->release(std::nan("")), continuum::InvalidInput);
  open(mesh, 0.25 * length);
  solver->release(2e-3);
  solver->step();
  open(mesh, 0.5 * length);
  EXPECT_THROW(solver->release(2e-3), continuum::InvalidInput); // reactions of the first release still act
  solver->step();
  EXPECT_NO_THROW(solver->release(2e-3));
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int face : cell->face_indices())
      if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == opened)
        cell->face(face)->set_boundary_id(edge::bottom);
  run_until(*solver, solver->time() + 2e-3);
  EXPECT_THROW(solver->release(2e-3), continuum::InvalidInput); // a free node would be held
}

// A half model of a sheet with a gradient energy agrees with the whole sheet: on the plane of symmetry the tangential
// displacement has no normal gradient, the normal displacement is zero, and its normal gradient is free.
TEST(SymmetryPlane, HalvesASheet)
{
  const Pulled problem;
  const Constitution constitution(problem.law, problem.gradient);
  const auto pulled = std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.3 * X[0] + 0.1 * X[0] * X[0], 0.5 * X[1] * (1. + X[0])});
    });
  BoundaryConditions whole_conditions, half_conditions;
  for (const auto side : {edge::left, edge::top, edge::bottom})
    whole_conditions.displacements.push_back({side, pulled});
  for (const auto side : {edge::left, edge::top})
    half_conditions.displacements.push_back({side, pulled});
  half_conditions.displacements.push_back(
    {edge::bottom, pulled, dealii::ComponentMask(std::vector<bool>{false, true})});
  Mesh whole(MPI_COMM_SELF), half(MPI_COMM_SELF);
  continuum::make_rectangle(whole, {1., 1., 8, 8});
  dealii::GridGenerator::subdivided_hyper_rectangle(half, std::vector<unsigned int>{8, 4}, Point<2>(0., 0.),
                                                    Point<2>(1., 0.5), true);
  StaticSettings settings;
  settings.degree = 3;
  StaticSolver exact(whole, constitution, whole_conditions, settings);
  exact.solve();
  const std::vector<Point<2>> points{{0.3, 0.06}, {0.9, 0.01}, {0.55, 0.3}};
  const auto expected = exact.sheet().evaluate(exact.displacement(), points);
  const auto error = [&](const dealii::ComponentMask &mask)
  {
    half_conditions.normal_gradients = {{edge::bottom, constant(0., 0.), mask}};
    StaticSolver solver(half, constitution, half_conditions, settings);
    solver.solve();
    const auto found = solver.sheet().evaluate(solver.displacement(), points);
    double largest = 0.;
    for (std::size_t n = 0; n < points.size(); ++n)
      largest = support::largest_of({largest, (found[n].F - expected[n].F).norm()});
    return largest;
  };
  // The whole sheet has faces on the plane, with penalised jumps, so both agree up to the discretisation error.
  EXPECT_LT(error(dealii::ComponentMask(std::vector<bool>{true, false})), 2e-4);
  EXPECT_GT(error(dealii::ComponentMask(std::vector<bool>{true, true})), 1e-2);
  half_conditions.normal_gradients = {
    {edge::bottom, constant(0., 0.), dealii::ComponentMask(std::vector<bool>{false, false})}};
  EXPECT_THROW(StaticSolver(half, constitution, half_conditions, settings), continuum::InvalidInput);
}

} // namespace release_test
