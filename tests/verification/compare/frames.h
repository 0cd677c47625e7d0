/// Artificial frames, written by the writers of VTK.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkHigherOrderQuadrilateral.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

/// Deformed state of the plane, for both sides.
struct MadeUpState
{
  double time = 1.;
  bool moves = false; ///< has velocities
  std::function<std::array<double, 2>(double, double)> displacement = [](double X, double Y) {
    return std::array<double, 2>{{0.1 * X + 0.02 * Y, 0.2 * Y}};
  };
  std::string without;         ///< name of a field to omit
  double scale_of_stress = 1.; ///< factor of all stresses
  double scale_of_lengths = 1.;
  bool bad = false; ///< a value of the first Piola stress is NaN
};

inline void add_array(vtkDataSet &data, const MadeUpState &state, const char *name, int components, double value)
{
  if (name == state.without)
    return;
  vtkNew<vtkDoubleArray> values;
  values->SetName(name);
  values->SetNumberOfComponents(components);
  values->SetNumberOfTuples(data.GetNumberOfPoints());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    for (int c = 0; c < components; ++c)
      values->SetComponent(i, c, components == 9 ? (c == 0 || c == 4 ? value : 0.) : c == 0 ? value : 0.);
  data.GetPointData()->AddArray(values);
}

/// Adds the common fields: displacement as given, the others constant.
inline void add_fields(vtkDataSet &data, const MadeUpState &state)
{
  add_array(data, state, "displacement", 3, 0.);
  if (vtkDataArray *const u = data.GetPointData()->GetArray("displacement"))
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
    {
      const double *const X = data.GetPoint(i);
      const std::array<double, 2> at = state.displacement(X[0] / state.scale_of_lengths, X[1] / state.scale_of_lengths);
      u->SetTuple3(i, at[0], at[1], 0.);
    }
  add_array(data, state, "deformation_gradient", 9, 1.1);
  add_array(data, state, "first_piola_stress", 9, 1e5 * state.scale_of_stress);
  add_array(data, state, "cauchy_stress", 9, 1e5 * state.scale_of_stress);
  add_array(data, state, "strain_energy_density", 1, 1e4);
  if (state.bad)
    data.GetPointData()->GetArray("first_piola_stress")->SetComponent(0, 4, std::nan(""));
  vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(state.time);
  data.GetFieldData()->AddArray(time);
}

/// Writes a square lattice with diagonals on [0, width] x [0, height] [m], with a held rim.
inline std::string write_lattice(const std::string &path, const MadeUpState &state, int nx = 12, int ny = 8,
                                 double width = 0.06, double height = 0.04,
                                 const std::function<bool(double, double)> &removed = {})
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices, lines;
  vtkNew<vtkDoubleArray> held;
  held->SetName("held");
  std::vector<vtkIdType> id(static_cast<std::size_t>((nx + 1) * (ny + 1)), -1);
  const auto number = [&](int i, int j) -> vtkIdType & { return id[static_cast<std::size_t>(j * (nx + 1) + i)]; };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
    {
      const double X = width * i / nx;
      const double Y = height * j / ny;
      if (removed && removed(X, Y))
        continue;
      number(i, j) = points->InsertNextPoint(state.scale_of_lengths * X, state.scale_of_lengths * Y, 0.);
      vertices->InsertNextCell(1, &number(i, j));
      held->InsertNextValue(i == 0 || i == nx || j == 0 || j == ny ? 1. : 0.);
    }
  const std::array<std::array<int, 2>, 4> steps{{{{1, 0}}, {{0, 1}}, {{1, 1}}, {{-1, 1}}}};
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      for (const auto &[di, dj] : steps)
        if (i + di >= 0 && i + di <= nx && j + dj <= ny && number(i, j) >= 0 && number(i + di, j + dj) >= 0)
        {
          const std::array<vtkIdType, 2> ends{{number(i, j), number(i + di, j + dj)}};
          lines->InsertNextCell(2, ends.data());
        }
  vtkNew<vtkPolyData> sheet;
  sheet->SetPoints(points);
  sheet->SetVerts(vertices);
  sheet->SetLines(lines);
  add_fields(*sheet, state);
  add_array(*sheet, state, "velocity", 3, state.moves ? 2. : 0.);
  sheet->GetPointData()->AddArray(held);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(sheet);
  writer->Write();
  return path;
}

/// Map of the unit square to the sheet.
using Shape = std::function<std::array<double, 2>(double, double)>;

inline Shape rectangle(double width = 0.06, double height = 0.04)
{
  return [=](double r, double s) { return std::array<double, 2>{{width * r, height * s}}; };
}

/// Writes nx by ny Lagrange cells of a degree on a mapped square, each with its own points.
inline std::string write_continuum(const std::string &path, const MadeUpState &state, int degree = 3, int nx = 3,
                                   int ny = 2, const Shape &shape = rectangle())
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkUnstructuredGrid> sheet;
  sheet->Allocate(nx * ny);
  const std::array<int, 2> order{{degree, degree}};
  for (int cy = 0; cy < ny; ++cy)
    for (int cx = 0; cx < nx; ++cx)
    {
      const vtkIdType first = points->GetNumberOfPoints();
      const vtkIdType n = (degree + 1) * (degree + 1);
      std::vector<vtkIdType> ids;
      for (vtkIdType a = 0; a < n; ++a)
        ids.push_back(first + a);
      for (int j = 0; j <= degree; ++j)
        for (int i = 0; i <= degree; ++i)
        {
          const std::array<double, 2> X =
            shape((cx + static_cast<double>(i) / degree) / nx, (cy + static_cast<double>(j) / degree) / ny);
          points->InsertPoint(first + vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order.data()),
                              state.scale_of_lengths * X[0], state.scale_of_lengths * X[1], 0.);
        }
      sheet->InsertNextCell(degree == 1 ? VTK_QUAD : VTK_LAGRANGE_QUADRILATERAL, n, ids.data());
    }
  sheet->SetPoints(points);
  add_fields(*sheet, state);
  if (state.moves)
    add_array(*sheet, state, "velocity", 3, 2.);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(sheet);
  writer->Write();
  return path;
}
