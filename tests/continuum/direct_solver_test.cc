// Direct solver for a sequence of matrices.
#include "continuum/direct_solver.h"
#include "continuum/errors.h"
#include "sheets.h"

#include <gtest/gtest.h>

namespace direct_solver_test
{

using namespace latcon;
using namespace sheets;
using continuum::DirectSolver;
using continuum::Sheet;

// Tangents of a sheet under several stretches, made unsymmetric.
struct Tangents
{
  explicit Tangents(const unsigned int cells) : mesh(MPI_COMM_SELF)
  {
    continuum::make_rectangle(mesh, rectangle(cells, cells));
    const auto rest = affine(matrix(1., 0., 0., 1.));
    sheet = std::make_unique<Sheet>(
      mesh, continuum::Constitution(law), 3,
      continuum::BoundaryConditions{{continuum::edge::left, rest}, {continuum::edge::right, rest}});
    b = sheet->make_owned();
    sheet->for_each_owned_dof(
      [&](const auto dof, const unsigned int i, const Point<2> &X)
      {
        if (!sheet->homogeneous_constraints().is_constrained(dof))
          b(dof) = std::sin(40. * X[0] + 90. * X[1] + i);
      });
  }

  Sheet::Matrix at(const double stretch) const
  {
    Sheet::Matrix K;
    const auto &constraints = sheet->homogeneous_constraints();
    sheet->make_matrix(constraints, K);
    sheet->tangent(nodal(*sheet, [&](const Point<2> &X) { return (stretch - 1.) * Tensor<1, 2>(X); }), constraints, K);
    for (auto entry = K.begin(); entry != K.end(); ++entry)
      if (entry->row() < entry->column())
        entry->value() = 1.1 * entry->value();
    return K;
  }

  std::vector<double> solution(DirectSolver &solver, const Sheet::Matrix &K) const
  {
    solver.factorise(K);
    Sheet::Vector x = sheet->make_owned();
    solver.solve(x, b);
    Sheet::Vector residual = b;
    K.vmult(residual, x);
    residual -= b;
    EXPECT_LT(residual.l2_norm(), 1e-10 * b.l2_norm());
    return std::vector<double>(x.begin(), x.end());
  }

  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh;
  std::unique_ptr<Sheet> sheet;
  Sheet::Vector b;
};

// A resumed motion starts with another matrix than an uninterrupted one had before, and must give the same bits.
TEST(DirectSolver, KeptAnalysisChangesNoBit)
{
  const Tangents sheet(8);
  for (const auto library : {DirectSolver::Library::mumps, DirectSolver::Library::klu})
  {
    DirectSolver kept(library);
    std::vector<double> before;
    for (const double stretch : {1., 1.4, 2.9})
    {
      DirectSolver fresh(library);
      const Sheet::Matrix K = sheet.at(stretch);
      const std::vector<double> x = sheet.solution(kept, K);
      EXPECT_EQ(x, sheet.solution(fresh, K));
      EXPECT_NE(x, before);
      before = x;
    }
  }
}

TEST(DirectSolver, RecoversFromASingularMatrix)
{
  const Tangents sheet(4);
  DirectSolver solver;
  Sheet::Matrix K = sheet.at(1.3);
  const std::vector<double> x = sheet.solution(solver, K);
  Sheet::Matrix singular = sheet.at(1.3);
  singular = 0.;
  EXPECT_THROW(solver.factorise(singular), continuum::LinearSolverFailed);
  EXPECT_EQ(sheet.solution(solver, K), x);
}

// The estimate of MUMPS: more than the entries of the matrix, and less than a dense matrix would take.
TEST(DirectSolver, RefusesAMatrixWhoseFactorsDoNotFit)
{
  const Tangents sheet(12);
  const Sheet::Matrix K = sheet.at(1.3);
  const auto rows = static_cast<double>(K.m());
  DirectSolver enough(DirectSolver::Library::mumps, 8. * rows * rows);
  sheet.solution(enough, K);
  DirectSolver too_little(DirectSolver::Library::mumps, 8. * static_cast<double>(K.n_nonzero_elements()));
  const std::string message = message_of<continuum::InvalidInput>([&] { too_little.factorise(K); });
  EXPECT_NE(message.find(std::to_string(K.m()) + " unknowns"), std::string::npos) << message;
}

} // namespace direct_solver_test
