// Domains and their boundary ids, and refinement by jumps.
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "sheets.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/vector_tools_rhs.h>

#include <filesystem>
#include <map>

namespace meshes_test
{

using namespace latcon;
using namespace sheets;
using continuum::StaticSolver;

struct Measures
{
  double area;
  std::map<dealii::types::boundary_id, double> edges; // length per edge
};

// Measures area and edges with the mapping of a sheet of this degree: loads by uniform tractions.
Measures measures(const continuum::Sheet &sheet)
{
  Measures result{dealii::GridTools::volume(sheet.mesh(), sheet.mapping()), {}};
  const auto &edges = sheet.mesh().get_boundary_ids();
  for (const dealii::types::boundary_id edge : edges)
  {
    dealii::Vector<double> load(sheet.dof_handler().n_dofs());
    dealii::VectorTools::create_boundary_right_hand_side(
      sheet.mapping(), sheet.dof_handler(), dealii::QGauss<1>(sheet.degree() + 2),
      dealii::Functions::ConstantFunction<2>(std::vector<double>{1., 0.}), load, {edge});
    result.edges[edge] = load.mean_value() * load.size();
  }
  return result;
}

std::filesystem::path write_file(const std::string &name, const std::string &text)
{
  static const TemporaryFolder folder;
  folder.write(name, text);
  return folder / name;
}

// Two squares side by side, 2 m x 1 m, with physical curves 2 (bottom of both), 4 (the right edge) and 0 (the rest).
const char *const two_squares = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
8
1 1 2 2 1 1 2
2 1 2 2 1 2 3
3 1 2 4 2 3 6
4 1 2 0 3 6 5
5 1 2 0 3 5 4
6 1 2 0 3 4 1
7 3 2 7 1 1 2 5 4
8 3 2 7 1 2 3 6 5
$EndElements
)";

TEST(Meshes, HoleHasItsAreaAndRim)
{
  const continuum::CauchyBorn law = rubber_network();
  for (const double radius : {0.005, 0.02, 0.044})
  {
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle_with_hole(mesh, {length, height, radius, 2});
    const Measures m = measures(continuum::Sheet(mesh, law, 4));
    // Each of 32 arcs is a polynomial of degree 4; the error of the area is that of interpolating a circle.
    EXPECT_NEAR(m.area, length * height - pi * radius * radius, 1e-8 * radius * radius);
    EXPECT_NEAR(m.edges.at(continuum::edge::inner), 2. * pi * radius, 1e-8 * radius);
    EXPECT_NEAR(m.edges.at(continuum::edge::left), height, 1e-12);
    EXPECT_NEAR(m.edges.at(continuum::edge::right), height, 1e-12);
    EXPECT_NEAR(m.edges.at(continuum::edge::bottom), length, 1e-12);
    EXPECT_NEAR(m.edges.at(continuum::edge::top), length, 1e-12);
  }
}

TEST(Meshes, NotchHasTwoFacesAndNoArea)
{
  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_notched_rectangle(mesh, {length, height, 0.06, 2});
  const Measures m = measures(continuum::Sheet(mesh, law, 2));
  EXPECT_NEAR(m.area, length * height, 1e-12);
  EXPECT_NEAR(m.edges.at(continuum::edge::inner), 2. * 0.06, 1e-12);
  EXPECT_NEAR(m.edges.at(continuum::edge::left), height, 1e-12);
}

TEST(Meshes, ReadsGmsh)
{
  const continuum::CauchyBorn law = rubber_network();
  Mesh mesh(MPI_COMM_SELF);
  continuum::read_gmsh(mesh, write_file("two_squares.msh", two_squares), 1);
  EXPECT_EQ(mesh.n_active_cells(), 8u);
  const Measures m = measures(continuum::Sheet(mesh, law, 2));
  EXPECT_NEAR(m.area, 2., 1e-12);
  EXPECT_NEAR(m.edges.at(2), 2., 1e-12);
  EXPECT_NEAR(m.edges.at(4), 1., 1e-12);
  EXPECT_NEAR(m.edges.at(0), 3., 1e-12);
}

TEST(Meshes, CellsAreKnownBeforeThereIsAMesh)
{
  for (const double radius : {1e-3, 3e-3, 8e-3})
  {
    const continuum::RectangleWithHole shape{0.06, 0.04, radius, 0};
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle_with_hole(mesh, shape);
    EXPECT_EQ(continuum::n_coarse_cells(shape), mesh.n_global_active_cells()) << radius;
  }
  for (const double notch : {1e-3, 0.02, 0.059})
  {
    const continuum::NotchedRectangle shape{0.06, 0.004, notch, 0};
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_notched_rectangle(mesh, shape);
    EXPECT_EQ(continuum::n_coarse_cells(shape), mesh.n_global_active_cells()) << notch;
  }
  EXPECT_GT(continuum::n_coarse_cells(continuum::RectangleWithHole{1e6, 1e6, 1., 0}), 1e10);
}

// Returns why a mesh, two_squares with parts replaced, is refused; empty if it is not.
using Changes = std::vector<std::pair<std::string, std::string>>;
std::string refusal(const Changes &changes)
{
  std::string other = two_squares;
  for (const auto &[from, to] : changes)
    other.replace(other.find(from), from.size(), to);
  return message_of<continuum::InvalidInput>([&] { (void)continuum::n_coarse_cells(write_file("other.msh", other)); });
}

std::string names(const std::string &lines)
{
  return "$PhysicalNames\n" + lines + "\n$EndPhysicalNames\n$Nodes";
}

TEST(Meshes, RefusesWhatCannotBeMeshed)
{
  Mesh mesh(MPI_COMM_SELF);
  EXPECT_THROW(continuum::make_rectangle(mesh, {0., 1., 1, 1}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_rectangle(mesh, {1., 1., 1, 0}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_rectangle(mesh, {1., 1., 1, 2, true, false}), continuum::InvalidInput);
  EXPECT_NO_THROW(RectangleMesh({1., 1., 2, 2, true, true}));
  EXPECT_THROW(continuum::make_rectangle_with_hole(mesh, {length, height, 0.046, 0}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_rectangle_with_hole(mesh, {length, height, 0., 0}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_notched_rectangle(mesh, {length, height, length, 0}), continuum::InvalidInput);
  EXPECT_THROW(continuum::make_notched_rectangle(mesh, {length, -1., 0.01, 0}), continuum::InvalidInput);
  EXPECT_THROW(continuum::read_gmsh(mesh, "no/such.msh"), continuum::InvalidInput);
  EXPECT_THROW((void)continuum::n_coarse_cells("/dev/zero"), continuum::InvalidInput);
  const std::filesystem::path large = write_file("large.msh", two_squares);
  std::filesystem::resize_file(large, (std::size_t{256} << 20) + 1);
  EXPECT_THROW((void)continuum::n_coarse_cells(large), continuum::InvalidInput);
}

// Gmsh gives curves with names the numbers from 1 on, in the order of the script.
TEST(Meshes, NamesOfCurvesDecideWhereThereAreAny)
{
  std::string text = two_squares;
  text.replace(text.find("$Nodes"), 6, names("4\n1 0 \"left\"\n1 2 \"right\"\n1 4 \"bottom\"\n2 7 \"my rubber\""));
  Mesh mesh(MPI_COMM_SELF);
  continuum::read_gmsh(mesh, write_file("named.msh", text));
  const continuum::CauchyBorn law = rubber_network();
  const Measures m = measures(continuum::Sheet(mesh, law, 2));
  EXPECT_NEAR(m.edges.at(continuum::edge::left), 3., 1e-12);
  EXPECT_NEAR(m.edges.at(continuum::edge::right), 2., 1e-12);
  EXPECT_NEAR(m.edges.at(continuum::edge::bottom), 1., 1e-12);
}

TEST(Meshes, SaysInASentenceWhyAFileIsRefused)
{
  const std::string last = "8 3 2 7 1 2 3 6 5", node = "5 1 1 0", right = "3 1 2 4 2 3 6";
  struct Case
  {
    Changes changes;
    std::string part, other_part = "";
  };
  const std::vector<Case> cases{
    {{{"2.2 0 8", "4 0 8"}}, "version 4,", "version 2 or 4.1"},
    {{{"2.2 0 8", "4.0 0 8"}}, "version 4.0,", "version 2 or 4.1"},
    {{{"2.2 0 8", "3 0 8"}}, "version 3,", "version 2 or 4.1"},
    {{{"2.2 0 8", "2.2 1 8"}}, "binary", "ASCII"},
    {{{"$MeshFormat", "Point(1) = {0, 0, 0};"}}, "not a mesh of Gmsh", "$MeshFormat"},
    {{{last, "8 10 2 7 1 2 3 6 5"}}, "element 8 of type 10", "first order"},
    {{{last, "8 2 2 7 1 2 3 6"}}, "triangle", "Recombine"},
    {{{last, "8 3 2 7 1 2 3 6 9"}}, "element 8", "node 9"},
    {{{last, "8 3 2 7 1 2 3 6"}}, "'$EndElements' in $Elements", "number of a node"},
    {{{last, "8 3 2 7 1 1 2 5 4"}}, "overlap, at (0, 0) m", "two physical surfaces"},
    {{{"3 2 0 0", "3 two 0 0"}}, "'two' in $Nodes", "coordinate"},
    {{{right, "3 1 2 5 2 3 6"}}, "physical curve 5"},
    {{{right, "3 1 2 300 2 3 6"}}, "physical curve 300"},
    {{{right, "3 1 2 -1 2 3 6"}}, "physical curve -1"},
    // No line along the right edge, and a line along the edge between the squares instead.
    {{{"8\n1 1 2 2 1 1 2\n2 1 2 2 1 2 3\n3 1 2 4 2 3 6\n", "7\n1 1 2 2 1 1 2\n2 1 2 2 1 2 3\n"}},
     "from (2, 0) to (2, 1) m on no physical curve"},
    // Nodes 3 and 6 in other planes than the rest.
    {{{"3 2 0 0", "3 2 0 5"}}, "z = 0 and 5 m"},
    {{{"6 2 1 0", "6 2 1 -1e-3"}}, "z = "},
    // A line without tags.
    {{{"6 1 2 0 3 4 1", "6 1 0 4 1"}}, "lines on no physical curve"},
    // The node between the squares on top moves below the diagonal of one of them, or onto it.
    {{{node, "5 1.7 0.2 0"}}, "not convex, element "},
    {{{node, "5 1.5 0.5 0"}}, "not convex, element "},
    {{{node, "5 1 -1 0"}}, "not convex, element "},
    // Gmsh's `Save all elements`, or a mesh without physical groups, in version 2: nothing is on a physical group.
    {{{"1 1 2 2 1 1 2", "1 1 2 0 1 1 2"},
      {"2 1 2 2 1 2 3", "2 1 2 0 1 2 3"},
      {right, "3 1 2 0 2 3 6"},
      {"7 3 2 7 1 1 2 5 4", "7 3 2 0 1 1 2 5 4"},
      {last, "8 3 2 0 1 2 3 6 5"}},
     "Save all elements"},
    {{{"$Nodes", names("3\n1 0 \"left\"\n1 2 \"clamp\"\n1 4 \"top\"")}}, "curve 2 named \"clamp\""},
    {{{"$Nodes", names("2\n1 0 \"left\"\n1 4 \"top\"")}}, "curve 2 without a name"},
    {{{"$Nodes", names("2\n1 2 \"left\"\n1 2 \"right\"")}}, "curve 2 two names, \"left\" and \"right\""},
    // A line along the edge between the squares.
    {{{"8\n1 1 2", "9\n9 1 2 8 4 2 5\n1 1 2"},
      {"$Nodes", names("4\n1 0 \"left\"\n1 2 \"bottom\"\n1 4 \"right\"\n1 8 \"top\"")}},
     "not on the boundary, on the physical curve 8 named \"top\""},
  };
  for (const auto &[changes, part, other_part] : cases)
  {
    const std::string message = refusal(changes);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(other_part), std::string::npos) << message;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
  }
  const std::vector<Changes> accepted{
    {},
    {{"$MeshFormat", "$Comments\nwhat $Nodes cost\n$EndComments\n$MeshFormat"}},
    {{last, "8 3 2 7 1 5 6 3 2"}},          // clockwise
    {{"$Nodes", names("1\n2 7 \"left\"")}}, // a surface
    // All edges on curve 0, by intention.
    {{"1 1 2 2 1 1 2", "1 1 2 0 1 1 2"}, {"2 1 2 2 1 2 3", "2 1 2 0 1 2 3"}, {right, "3 1 2 0 2 3 6"}},
    // In a shifted plane.
    {{"1 0 0 0", "1 0 0 5"},
     {"2 1 0 0", "2 1 0 5"},
     {"3 2 0 0", "3 2 0 5"},
     {"4 0 1 0", "4 0 1 5"},
     {node, "5 1 1 5"},
     {"6 2 1 0", "6 2 1 5"}}};
  for (const Changes &changes : accepted)
    EXPECT_EQ(refusal(changes), "");
}

// As Gmsh writes it: a square of one cell, numbers of curves among the entities.
TEST(Meshes, RefusesCurvesWithoutANumberOfFormat4)
{
  const auto square = [](const std::string &right)
  {
    return R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
4 4 1 0
1 0 0 0 0
2 1 0 0 0
3 1 1 0 0
4 0 1 0 0
1 0 0 0 1 0 0 1 2 2 1 -2
2 1 0 0 1 1 0 )" +
           right + R"( 2 2 -3
3 0 1 0 1 1 0 1 3 2 3 -4
4 0 0 0 0 1 0 1 0 2 4 -1
1 0 0 0 1 1 0 1 9 4 1 2 3 4
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
5 5 1 5
1 1 1 1
1 1 2
1 2 1 1
2 2 3
1 3 1 1
3 3 4
1 4 1 1
4 4 1
2 1 3 1
5 1 2 3 4
$EndElements
)";
  };
  Mesh mesh(MPI_COMM_SELF);
  continuum::read_gmsh(mesh, write_file("square.msh", square("1 1")));
  for (const auto &face : mesh.begin_active()->face_iterators())
  {
    const dealii::Point<2> X = face->center();
    EXPECT_EQ(face->boundary_id(), X[0] == 0.   ? continuum::edge::left
                                   : X[0] == 1. ? continuum::edge::right
                                   : X[1] == 0. ? continuum::edge::bottom
                                                : continuum::edge::top);
  }
  EXPECT_THROW((void)continuum::n_coarse_cells(write_file("square.msh", square("0"))), continuum::InvalidInput);
  EXPECT_THROW((void)continuum::n_coarse_cells(write_file("square.msh", square("1 7"))), continuum::InvalidInput);
}

// theory-continuum.md, eq. (C.33): the error of the energy falls faster than with the square root of the number of
// unknowns, its rate on uniform meshes because of the singularity at the tip.
TEST(Refinement, IsDenseAtTheTipOfANotch)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.005);
  const auto field = affine(matrix(1., 0., 0., 1.3));
  const continuum::BoundaryConditions conditions{{continuum::edge::bottom, field}, {continuum::edge::top, field}};
  Mesh here(MPI_COMM_SELF);
  continuum::make_notched_rectangle(here, {length, height, 0.06, 1});
  StaticSolver adaptive(here, continuum::Constitution(law, gradient), conditions);
  adaptive.solve();
  std::vector<double> energies;
  std::vector<double> unknowns;
  for (unsigned int cycle = 0; cycle < 6; ++cycle)
  {
    adaptive.refine(here, 0.12);
    const continuum::SolverReport report = adaptive.equilibrate();
    EXPECT_EQ(report.load_steps.size(), 1u) << report.text(); // from the interpolated state, not from zero
    energies.push_back(adaptive.total_energy());
    unknowns.push_back(adaptive.sheet().dof_handler().n_dofs());
  }
  double smallest = 1.;
  double distance = 1.;
  for (const auto &cell : here.active_cell_iterators())
    if (cell->diameter() < smallest)
    {
      smallest = cell->diameter();
      distance = cell->center().distance(Point<2>(0.06, 0.));
    }
  EXPECT_LT(distance, 0.005);
  // The error of the last mesh is about the last change.
  const auto error = [&](const unsigned int cycle) { return energies[cycle] - 2. * energies[5] + energies[4]; };
  EXPECT_GT(std::log(error(1) / error(3)) / std::log(unknowns[3] / unknowns[1]), 1.);
}

} // namespace meshes_test
