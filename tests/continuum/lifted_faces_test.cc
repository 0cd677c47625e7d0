// The faces of a cell that are lifted, on refined and periodic meshes: each is one of both cells, together they are the
// perimeter, and matrices have entries for them.
#include "continuum/lifted_shapes.h"
#include "multigrid_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lifted_faces_test
{

using namespace latcon;
using namespace sheets;

constexpr unsigned int whole = dealii::numbers::invalid_unsigned_int;

double length_of(const continuum::LiftedFace::Cell &cell, const unsigned int face, const unsigned int half)
{
  return (half == whole ? 1. : 0.5) * cell->face(face)->measure();
}

TEST(LiftedFaces, AreThoseOfBothCells)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.01);
  for (const bool periodic : {false, true})
  {
    // Refined around a corner, so that hanging nodes are on periodic edges as well.
    RectangleMesh mesh({length, height, 4, 4, periodic, periodic});
    multigrid_cases::refine_towards(mesh, Point<2>(0., -0.5 * height), 2, 0.5 * length);
    const continuum::Sheet sheet(mesh, continuum::Constitution(law, gradient), 2);
    unsigned int n_halves = 0;
    for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    {
      double inside = 0.;
      for (const unsigned int face : cell->face_indices())
        inside += cell->at_boundary(face) && !periodic ? 0. : cell->face(face)->measure();
      for (const continuum::LiftedFace &at : continuum::lifted_faces(sheet, cell))
      {
        inside -= length_of(cell, at.face, at.subface);
        n_halves += at.subface != whole ? 1 : 0;
        EXPECT_EQ(at.face ^ 1u, at.neighbor_face);
        EXPECT_NEAR(length_of(cell, at.face, at.subface), length_of(at.neighbor, at.neighbor_face, at.neighbor_subface),
                    1e-15);
        const auto beyond = continuum::lifted_faces(sheet, at.neighbor);
        EXPECT_EQ(std::count_if(beyond.begin(), beyond.end(),
                                [&](const continuum::LiftedFace &back)
                                {
                                  return back.neighbor == cell && back.face == at.neighbor_face &&
                                         back.subface == at.neighbor_subface && back.neighbor_face == at.face &&
                                         back.neighbor_subface == at.subface;
                                }),
                  1);
      }
      EXPECT_NEAR(inside, 0., 1e-15);
    }
    EXPECT_GT(n_halves, 8u);
    continuum::Sheet::Matrix K;
    sheet.make_matrix(sheet.conformity_constraints(), K);
    EXPECT_NO_THROW(sheet.tangent(sheet.make_ghosted(), sheet.conformity_constraints(), K));
  }
}

} // namespace lifted_faces_test
