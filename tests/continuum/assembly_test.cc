// Assembly of matrices and vectors. On one rank in the unit tests, on several in ranks_tests.
#include "continuum/element_integrals.h"
#include "continuum/meshes.h"
#include "continuum/shape_tables.h"
#include "continuum/single_precision_matrix.h"
#include "multigrid_cases.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

namespace assembly_test
{

using namespace latcon;
using namespace multigrid_cases;

// Makes a mesh with cells of three sizes and hanging nodes.
void make_adaptive(Mesh &mesh)
{
  continuum::make_rectangle(mesh, rectangle(6, 4));
  refine_towards(mesh, Point<2>(0.4 * length, 0.003), 2, length / 4.);
}

// Returns a continuous state that is homogeneous nowhere, with ghost entries.
Sheet::Vector wavy_state(const Sheet &sheet)
{
  return nodal(sheet,
               [](const Point<2> &X)
               {
                 const double wave = 300. * (X[0] + 2. * X[1]);
                 return Tensor<1, 2>({0.3 * X[0] + 2e-4 * std::sin(wave), 0.3 * X[1] + 2e-4 * std::sin(wave + 1.)});
               });
}

// A law that changes on a line between two columns of cells.
class TwoPieces : public continuum::Material
{
public:
  const Material &at(const Point<2> &X) const override { return X[0] < 0.625 * length ? left : right; }
  continuum::Response evaluate(const Tensor<2, 2> &F, const continuum::Order order) const override
  {
    return left.evaluate(F, order);
  }

  const continuum::MooneyRivlin left = rubber_sheet(), right = rubber_sheet(0.3);
};

// Loads are those of the selected components. The first moments of double tractions on the upper edge are their sums.
TEST(Assembly, LoadsSelectedComponents)
{
  const continuum::MooneyRivlin law = rubber_sheet();
  const continuum::IsotropicGradient gradient(5e5, 0.01);
  Mesh mesh(MPI_COMM_WORLD);
  continuum::make_rectangle(mesh, rectangle(3, 2));
  const auto ones = std::make_shared<dealii::Functions::ConstantFunction<2>>(1., 2);
  const auto only = [](const unsigned int i) { return dealii::ComponentMask(std::vector<bool>{i == 0, i == 1}); };
  continuum::BoundaryConditions conditions;
  conditions.tractions.push_back({continuum::edge::top, ones, only(1)});
  conditions.double_tractions.push_back({continuum::edge::top, ones, only(0)});
  const Sheet sheet(mesh, continuum::Constitution(law, gradient), 2, conditions);
  const auto work = [&](const auto &u) { return owned(sheet, nodal(sheet, u)) * sheet.loads(); };
  for (unsigned int i = 0; i < 2; ++i)
  {
    Tensor<1, 2> e;
    e[i] = 1.;
    EXPECT_NEAR(work([&](const Point<2> &) { return e; }), i * length, 1e-14 * length);
    EXPECT_NEAR(work([&](const Point<2> &X) { return (X[1] - 0.5 * height) * e; }), (1 - i) * length, 1e-14 * length);
  }
}

// Of four columns of trapezoids that become narrower, each has its own points.
TEST(Assembly, FindsTheLawOfEveryPoint)
{
  const TwoPieces law;
  Mesh mesh(MPI_COMM_WORLD);
  continuum::make_rectangle(mesh, rectangle(4, 2));
  const auto moved = [](const Point<2> &X)
  { return Point<2>(X[0] * (1.5 - 0.5 * X[0] / length), X[1] * (1. + 0.5 * X[0] / length)); };
  dealii::GridTools::transform(moved, mesh);
  const Sheet sheet(mesh, law, 2);
  const Tensor<2, 2> F = matrix(1.5, 0.1, 0.2, 1.2);
  const auto u = nodal(sheet, [&F](const Point<2> &X) { return F * Tensor<1, 2>(X) - Tensor<1, 2>(X); });
  const double expected = (law.left.energy(F) * 179. + law.right.energy(F) * 131.) / 256. * length * height;
  EXPECT_NEAR(sheet.energy(u), expected, 1e-12 * expected);
}

// Compares shared tables with tables of each cell: straight cells of several sizes, and curved cells.
TEST(Assembly, SharesTheTablesOfEqualCells)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.01);
  for (const bool has_hole : {false, true})
  {
    Mesh mesh(MPI_COMM_SELF);
    if (has_hole)
      continuum::make_rectangle_with_hole(mesh, {length, height, 0.02, 1});
    else
      make_adaptive(mesh);
    const Sheet sheet(mesh, continuum::Constitution(law, gradient), 3);
    continuum::ShapeTables tables(sheet);
    const dealii::FE_Q<2> element(3);
    const auto flags = dealii::update_gradients | dealii::update_hessians | dealii::update_JxW_values;
    dealii::FEValues<2> cell_values(sheet.mapping(), element, dealii::QGauss<2>(4), flags);
    dealii::FEFaceValues<2> face_values(sheet.mapping(), element, dealii::QGauss<1>(4), flags);
    dealii::FESubfaceValues<2> subface_values(sheet.mapping(), element, dealii::QGauss<1>(4), flags);
    const auto expect_same = [](const dealii::FEValuesBase<2> &exact, const continuum::ShapeTable &table)
    {
      ASSERT_EQ(table.n_points, exact.n_quadrature_points);
      for (unsigned int q = 0; q < table.n_points; ++q)
      {
        EXPECT_NEAR(table.JxW[q], exact.JxW(q), 1e-10 * exact.JxW(q));
        for (unsigned int a = 0; a < exact.dofs_per_cell; ++a)
        {
          const Tensor<1, 2> &first = exact.shape_grad(a, q);
          const Tensor<2, 2> &second = exact.shape_hessian(a, q);
          const double derivative[] = {first[0], first[1], second[0][0], second[1][1], second[0][1]};
          // Edges are equal to 1e-11 of their length.
          for (unsigned int c = 0; c < 5; ++c)
            EXPECT_NEAR(table.row(q, c)[a], derivative[c], 1e-9 * (c < 2 ? first.norm() + 1. : second.norm() + 1e3));
        }
      }
    };
    for (const auto &cell : mesh.active_cell_iterators())
    {
      cell_values.reinit(cell);
      expect_same(cell_values, tables.cell(cell));
      for (const unsigned int face : cell->face_indices())
      {
        face_values.reinit(cell, face);
        expect_same(face_values, tables.face(cell, face, dealii::numbers::invalid_unsigned_int, 0));
        if (!cell->at_boundary(face) && cell->neighbor(face)->has_children())
        {
          subface_values.reinit(cell, face, 1);
          expect_same(subface_values, tables.face(cell, face, 1, 1));
        }
      }
    }
  }
}

// A matrix in single precision is that in double precision up to the rounding of its entries to 24 bits after each
// addition; forces of a translation along it are exact. The rows of a node with one held component differ, and the
// other component of a node of degree 3 may be in another block.
TEST(Assembly, AddsInSinglePrecision)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::LatticeGradient gradient = rubber_gradient(0.01);
  for (const double scale : {1., 0.6})
    for (const unsigned int degree : {2u, 3u})
    {
      Mesh mesh(MPI_COMM_WORLD);
      make_adaptive(mesh);
      const Sheet sheet(mesh, continuum::Constitution(law, gradient), degree, left_held_across());
      const AffineConstraints<double> &constraints = sheet.homogeneous_constraints();
      Sheet::Matrix K;
      continuum::SinglePrecisionMatrix single;
      sheet.make_matrix(constraints, K);
      single.reinit(sheet, constraints);
      const auto assemble = [&](auto &matrix)
      {
        sheet.tangent(wavy_state(sheet), constraints, matrix);
        matrix *= scale;
        sheet.add_mass(1e9, 0.01, constraints, matrix);
      };
      assemble(K);
      assemble(single);

      const auto layout = std::make_shared<const dealii::Utilities::MPI::Partitioner>(sheet.owned(), sheet.relevant(),
                                                                                      sheet.communicator());
      // Returns both products with a vector that is zero at prescribed unknowns.
      const auto products = [&](const std::function<double(unsigned int, const Point<2> &)> &field)
      {
        Sheet::Vector x = sheet.make_owned(), y = sheet.make_owned();
        sheet.for_each_owned_dof([&](const auto dof, const unsigned int i, const Point<2> &X)
                                 { x(dof) = constraints.is_constrained(dof) ? 0. : field(i, X); });
        x.compress(dealii::VectorOperation::insert);
        K.vmult(y, x);
        Multigrid::Vector from(layout), to(layout);
        Multigrid::copy(x, from);
        single.vmult(to, from);
        return std::make_pair(y, to);
      };
      const auto [y, of_single] =
        products([](const unsigned int i, const Point<2> &X) { return std::sin(400. * X[0] + 700. * X[1] + i); });
      const auto [along_y, along_y_of_single] = products([](const unsigned int i, const Point<2> &) { return i; });
      sheet.for_each_owned_dof(
        [&, &y = y, &of_single = of_single, &along_y = along_y,
         &along_y_of_single = along_y_of_single](const auto dof, const unsigned int i, const Point<2> &)
        {
          double sum = 0.;
          for (auto entry = K.begin(dof); entry != K.end(dof); ++entry)
            sum += std::abs(entry->value());
          const double rounding = std::ldexp(sum, -22); // measured: a quarter
          if (constraints.is_constrained(dof))
          {
            EXPECT_EQ(of_single(dof), 0.);
            return;
          }
          EXPECT_NEAR(of_single(dof), y(dof), rounding);
          EXPECT_NEAR(single.diag_element(dof), K.diag_element(dof), rounding);
          EXPECT_NEAR(along_y_of_single(dof), along_y(dof), i == 1 ? 1e-12 * sum : rounding);
        });
    }
}

} // namespace assembly_test
