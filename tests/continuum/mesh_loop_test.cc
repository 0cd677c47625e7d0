// Compares the loop over cells and faces with that of deal.II on each rank: equal calls in equal order.
#include "continuum/mesh_loop.h"
#include "sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/meshworker/assemble_flags.h>
#include <deal.II/meshworker/mesh_loop.h>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace mesh_loop_test
{

using namespace latcon;
using namespace sheets;

using Iterator = dealii::DoFHandler<2>::active_cell_iterator;

// Call: cells, and numbers of faces and subfaces.
using Call = std::pair<std::array<std::string, 2>, std::array<unsigned int, 4>>;
using Calls = std::vector<Call>;
constexpr unsigned int none = 99;

struct Recorder
{
  Calls calls;
  void cell(const Iterator &cell) { calls.push_back({{{cell->id().to_string(), ""}}, {{none, none, none, none}}}); }
  void boundary(const Iterator &cell, const unsigned int face)
  {
    calls.push_back({{{cell->id().to_string(), ""}}, {{face, none, none, none}}});
  }
  void interior(const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
                const unsigned int neighbor_face, const unsigned int neighbor_subface)
  {
    calls.push_back(
      {{{cell->id().to_string(), neighbor->id().to_string()}}, {{face, subface, neighbor_face, neighbor_subface}}});
  }
  void cell_end() {}
};

struct Nothing
{
};

Calls calls_of_deal_ii(const dealii::DoFHandler<2> &dofs)
{
  using namespace dealii::MeshWorker;
  Calls calls;
  mesh_loop(
    dofs.begin_active(), dofs.end(), [](const Iterator &cell, Nothing &, Recorder &here) { here.cell(cell); },
    [&](const Recorder &here) { calls.insert(calls.end(), here.calls.begin(), here.calls.end()); }, Nothing(),
    Recorder(),
    assemble_own_cells | assemble_boundary_faces | assemble_own_interior_faces_once | assemble_ghost_faces_once,
    [](const Iterator &cell, const unsigned int face, Nothing &, Recorder &here) { here.boundary(cell, face); },
    [](const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
       const unsigned int neighbor_face, const unsigned int neighbor_subface, Nothing &, Recorder &here)
    { here.interior(cell, face, subface, neighbor, neighbor_face, neighbor_subface); });
  return calls;
}

// Makes a mesh that is refined around a corner, with hanging nodes also at rank boundaries and on periodic edges.
void make_refined(Mesh &mesh, const bool periodic)
{
  auto shape = rectangle(4, 4);
  shape.periodic_x = shape.periodic_y = periodic;
  continuum::make_rectangle(mesh, shape);
  for (int pass = 0; pass < 2; ++pass)
  {
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.4 * length && cell->center()[1] < 0.1 * height)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
}

TEST(MeshLoop, CallsWhatDealIICalls)
{
  const dealii::FE_Q<2> element(1);
  for (const bool periodic : {false, true})
  {
#ifdef DEBUG
    if (periodic) // an internal assertion of deal.II's loop fails here
      continue;
#endif
    Mesh mesh(MPI_COMM_WORLD);
    make_refined(mesh, periodic);
    dealii::DoFHandler<2> dofs(mesh);
    dofs.distribute_dofs(element);
    Recorder own;
    continuum::for_each_cell_and_face(dofs, own);
    const Calls expected = calls_of_deal_ii(dofs);
    EXPECT_EQ(own.calls, expected);
    std::size_t to_coarser = 0;
    for (const Call &call : own.calls)
      to_coarser += call.second[3] < 2 ? 1 : 0;
    EXPECT_GT(dealii::Utilities::MPI::sum(to_coarser, MPI_COMM_WORLD), 4u);
  }
}

// Periodic edges in all builds: each face between cells is visited once over all ranks, and no face is a boundary.
TEST(MeshLoop, VisitsPeriodicFacesOnce)
{
  const dealii::FE_Q<2> element(1);
  Mesh mesh(MPI_COMM_WORLD);
  make_refined(mesh, true);
  dealii::DoFHandler<2> dofs(mesh);
  dofs.distribute_dofs(element);
  struct Lengths
  {
    double cells = 0., faces = 0., edges = 0.;
    void cell(const Iterator &cell)
    {
      for (const unsigned int face : cell->face_indices())
        cells += cell->face(face)->measure();
    }
    void boundary(const Iterator &cell, const unsigned int face) { edges += cell->face(face)->measure(); }
    void interior(const Iterator &cell, const unsigned int face, unsigned int, const Iterator &, unsigned int,
                  unsigned int)
    {
      faces += cell->face(face)->measure();
    }
    void cell_end() {}
  } lengths;
  continuum::for_each_cell_and_face(dofs, lengths);
  const auto sum = [](const double x) { return dealii::Utilities::MPI::sum(x, MPI_COMM_WORLD); };
  EXPECT_EQ(sum(lengths.edges), 0.);
  // Every face has two sides.
  EXPECT_NEAR(2. * sum(lengths.faces), sum(lengths.cells), 1e-12 * sum(lengths.cells));
}

} // namespace mesh_loop_test
