// Files of the continuum, read back by VTK in Python; check_fields.py has independent formulas.
#include "continuum/errors.h"
#include "continuum/field_writer.h"
#include "moving_sheets.h"
#include "sheets.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

namespace field_writer_test
{

using namespace latcon;
using namespace sheets;
namespace fs = std::filesystem;

struct FieldWriter : testing::Test
{
  TemporaryFolder parent_;
  fs::path directory_ = parent_ / "fields"; // not there yet
};

TEST_F(FieldWriter, IsReadByVtkWithNamesTimesAndValues)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(6, 4));
  continuum::StaticSettings settings;
  settings.first_load_step = 1. / 3.; // a time with more than 6 digits
  continuum::StaticSolver solver(mesh, law, on_all_edges(affine(matrix(2.3, 0.25, -0.1, 1.4))), settings);
  // A removed parent folder is not created again, because the run was removed with it.
  EXPECT_THROW(continuum::FieldWriter(MPI_COMM_SELF, directory_ / "deeper"), continuum::OutputFailed);
  fs::create_directory(directory_);
  continuum::FieldWriter writer(MPI_COMM_SELF, directory_ / "deeper");
  writer.add_frame(0., solver.sheet(), solver.displacement());
  solver.solve([&](const double factor) { writer.add_frame(factor, solver.sheet(), solver.displacement()); });
  const std::string command = std::string(PYTHON) + " " + CHECK_FIELDS + " " + writer.collection().string() + " 3 24";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

// Those of the lattice do too. A rate that varies within a cell, so that the order of its points matters.
TEST_F(FieldWriter, StressesOfAMotionIncludeThoseOfViscosityAndBranches)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::FibreViscosity viscosity = moving_sheets::network_viscosity(300.);
  const continuum::FibreMemory memory = moving_sheets::network_memory(2e5, {1e-3});
  RectangleMesh mesh(rectangle(3, 2));
  continuum::DynamicSettings settings{1e-5};
  continuum::DynamicSolver solver(mesh, continuum::Constitution(law), {}, continuum::Inertia{950.}, settings,
                                  &viscosity, &memory);
  const Tensor<2, 2> F = matrix(2.3, 0.25, -0.1, 1.4);
  const auto u = nodal(solver.sheet(), [F](const Point<2> &X) { return F * Tensor<1, 2>(X) - Tensor<1, 2>(X); });
  const auto v = nodal(solver.sheet(),
                       [](const Point<2> &X) {
                         return Tensor<1, 2>({40. * X[0], 900. * X[0] * X[1]});
                       });
  solver.start(u, v, {solver.sheet().make_ghosted()});
  continuum::FieldWriter writer(MPI_COMM_SELF, directory_);
  writer.add_frame(solver);
  const std::string command = std::string(PYTHON) + " " + CHECK_FIELDS + " " + writer.collection().string() + " motion";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(FieldWriter, LeavesNoHalfFileAndThrowsWhenItCannotWrite)
{
  const continuum::CauchyBorn law = rubber_network();
  RectangleMesh mesh(rectangle(2, 2));
  const continuum::Sheet sheet(mesh, law, 1);
  std::ofstream(directory_) << "a file where the folder should be";
  EXPECT_THROW(continuum::FieldWriter(MPI_COMM_SELF, directory_ / "fields"), continuum::OutputFailed);
  fs::remove(directory_);
  continuum::FieldWriter writer(MPI_COMM_SELF, directory_, "sheet");
  writer.add_frame(0., sheet, sheet.make_ghosted());
  // A corner so far inside its cell that det F is negative there, but not at quadrature points.
  const auto folded = [](const Point<2> &X)
  { return (X[0] > 0.9 * length && X[1] > 0.4 * height ? -0.275 : 0.) * Tensor<1, 2>({length, height}); };
  EXPECT_NO_THROW(writer.add_frame(0.1, sheet, nodal(sheet, folded)));
  EXPECT_THROW(writer.add_frame(0.1, sheet, sheet.make_ghosted()), continuum::InvalidInput);
  std::set<std::string> names;
  for (const auto &entry : fs::directory_iterator(directory_))
    names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"sheet.pvd", "sheet_0000.vtu", "sheet_0001.vtu"}));
  fs::remove_all(directory_);
  EXPECT_THROW(writer.add_frame(0.2, sheet, sheet.make_ghosted()), continuum::OutputFailed);
}

} // namespace field_writer_test
