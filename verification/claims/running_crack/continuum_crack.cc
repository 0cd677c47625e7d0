#include "verification/claims/running_crack/running_crack_claim.h"

#include <algorithm>
#include <memory>

#include <deal.II/grid/grid_generator.h>

#include "continuum/field_writer.h"
#include "continuum/flank.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/homogenisation.h"

namespace latcon::claims
{
namespace
{

using Mesh = continuum::Sheet::Mesh;

constexpr dealii::types::boundary_id crack = 10; // the part of the lower edge that is open

// Parts of an interval: equal ones of `pitch` from `to` backwards, the first of them longer or shorter by up to a half.
std::vector<double> parts(double extent, double pitch)
{
  const auto n = std::max<long>(1, std::lround(extent / pitch));
  std::vector<double> list(static_cast<std::size_t>(n), pitch);
  list.front() = extent - static_cast<double>(n - 1) * pitch;
  return list;
}

// Graded towards the path. A vertex is where the tip starts, and from there on every finest cell.
void make_mesh(Mesh &mesh, const CrackDrive &drive, const HalfSheet &half, const CrackMesh &resolution)
{
  const double finest = resolution.finest * drive.stride(), start = drive.start + half.tip;
  double coarsest = finest;
  unsigned int levels = 0;
  for (; coarsest < 3. * drive.spacing; coarsest *= 2.)
    ++levels;
  std::vector<double> x = parts(start - half.left, coarsest), right = parts(half.right - start, coarsest);
  x.insert(x.end(), right.rbegin(), right.rend());
  const auto n_y = static_cast<std::size_t>(std::max<long>(1, std::lround(half.height / coarsest)));
  const std::vector<double> y(n_y, half.height / static_cast<double>(n_y));
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, std::vector<std::vector<double>>{x, y},
                                                    dealii::Point<2>(half.left, drive.axis()),
                                                    dealii::Point<2>(half.right, drive.axis() + half.height), true);
  double size = coarsest;
  for (unsigned int level = 0; level < levels; ++level)
  {
    size *= 0.5;
    const double distance = 4. * size;
    for (const auto &cell : mesh.active_cell_iterators())
    {
      const auto box = cell->bounding_box().get_boundary_points();
      const double slack = 1e-6 * size;
      if (box.first[1] - drive.axis() < distance - slack && box.second[0] > start - distance + slack &&
          box.first[0] < drive.end() + half.tip + distance - slack)
        cell->set_refine_flag();
    }
    mesh.execute_coarsening_and_refinement();
  }
}

continuum::BoundaryConditions conditions(const Eigen::Matrix2d &F, bool has_gradient)
{
  using continuum::edge::bottom;
  const auto affine = std::make_shared<bridge::AffineDisplacement>(F);
  continuum::BoundaryConditions all;
  for (const auto edge : {continuum::edge::left, continuum::edge::right, continuum::edge::top})
    all.displacements.push_back({edge, affine});
  all.displacements.push_back({bottom, affine, dealii::ComponentMask(std::vector<bool>{false, true})});
  if (has_gradient)
    all.normal_gradients.push_back({bottom, std::make_shared<dealii::Functions::ZeroFunction<2>>(2),
                                    dealii::ComponentMask(std::vector<bool>{true, false})});
  return all;
}

// Moves the cells of the lower edge between two X to the boundary of the crack.
void open(Mesh &mesh, double from, double to)
{
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int face : cell->face_indices())
      if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == continuum::edge::bottom)
        if (const double X = cell->face(face)->center()[0]; X > from && X < to)
          cell->face(face)->set_boundary_id(crack);
}

// Distance of the bonds' stress from its mean over rotations of the lattice [Pa], whatever law is compared.
double anisotropy(const continuum::Material &bonds, const dealii::Tensor<2, 2> &F)
{
  dealii::Tensor<2, 2> mean;
  for (int k = 0; k < bridge::n_lattice_rotations; ++k)
  {
    const dealii::Tensor<2, 2> R = bridge::to_continuum(bridge::lattice_rotation(k));
    mean += bonds.first_piola_stress(F * R) * transpose(R) / bridge::n_lattice_rotations;
  }
  return (mean - bonds.first_piola_stress(F)).norm();
}

// Adds the fields of the continuum at the sites of a sample.
void add_sample(const CrackDrive &drive, const lattice::TriangularLattice &sheet, const WaveContinuum &medium,
                const continuum::Material &bonds, const Eigen::Matrix2d &F, const continuum::DynamicSolver &solver,
                double X_tip, double reach, TipField &field)
{
  const std::vector<TipSite> sites = tip_sites(drive, sheet, X_tip, reach);
  std::vector<dealii::Point<2>> points;
  for (const TipSite &site : sites)
    points.emplace_back(site.X, drive.axis() + site.eta);
  const std::vector<continuum::PointState> states = solver.sheet().evaluate(solver.displacement(), points);
  const std::vector<continuum::PointState> rates = solver.sheet().gradients(solver.velocity(), points);
  for (std::size_t n = 0; n < sites.size(); ++n)
  {
    TipValues values;
    for (unsigned int i = 0; i < 2; ++i)
    {
      values.velocity(i) = rates[n].displacement[i];
      values.excess(i) = points[n][i] + states[n].displacement[i] - F(i, 0) * points[n][0] - F(i, 1) * points[n][1];
    }
    values.opening_stress = states[n].P[1][1];
    const dealii::Tensor<2, 2> P = medium.constitution.local->first_piola_stress(states[n].F);
    values.excess_stress = (P - medium.constitution.local->first_piola_stress(bridge::to_continuum(F))).norm();
    values.anisotropy = anisotropy(bonds, states[n].F);
    if (medium.viscosity != nullptr)
    {
      continuum::PointIntegrand density;
      continuum::clear(density, continuum::Order::first);
      const auto add = [&](const continuum::Viscosity &law)
      {
        law.add_density(continuum::field_derivatives(states[n].F, states[n].G),
                        continuum::field_derivatives(rates[n].F, rates[n].G), continuum::Order::first, 0., density);
      };
      add(medium.viscosity->at(points[n]));
      values.opening_stress += density.first[1][1];
      if (const continuum::Viscosity *gradient = medium.viscosity->gradient())
        add(*gradient);
      values.dissipation = density.value;
    }
    field.add(sites[n], values);
  }
}

} // namespace

TipRun drive_continuum_crack(const CrackDrive &drive, const HalfSheet &half, const WaveContinuum &whole,
                             const std::vector<continuum::BondFamily> &cut, const continuum::Material &bonds,
                             const Eigen::Matrix2d &F, const CrackMesh &resolution, double reach,
                             const std::optional<CrackFrame> &frame)
{
  const lattice::TriangularLattice sheet(drive.spacing, drive.length, drive.height, drive.orientation);
  Mesh mesh(MPI_COMM_SELF);
  make_mesh(mesh, drive, half, resolution);
  const double cell = resolution.finest * drive.stride(), start = drive.start + half.tip;
  WaveContinuum medium = whole;
  continuum::Flank flank(drive.axis(), start, drive.pitch(), cut, *whole.constitution.local, whole.viscosity.get());
  medium.constitution.local = &flank.law();
  medium.viscosity = flank.viscosity();
  continuum::DynamicSettings settings;
  settings.time_step = drive.stride_time();
  settings.degree = resolution.degree;
  settings.relative_tolerance = 1e-6;
  settings.linear.direct_limit = 1000000;
  settings.max_step_halvings = 9;
  continuum::DynamicSolver solver(mesh, medium.constitution, conditions(F, medium.constitution.has_gradient()),
                                  medium.inertia, settings, medium.viscosity.get());
  solver.start(interpolated(solver.sheet(), bridge::AffineDisplacement(F)), solver.sheet().make_owned());

  TipRun run{TipField(drive), {}};
  continuum::EnergyLedger middle;
  double cut_energy = 0.; // of bonds, after the middle of the run [J/m]
  const unsigned int n_half = drive.n_strides / 2;
  unsigned int n_open = 0; // cells
  for (unsigned int stride = 1; stride <= drive.n_strides; ++stride)
  {
    if (stride == n_half + 1)
    {
      middle = solver.ledger();
      cut_energy = 0.;
    }
    if ((stride - 1) * drive.stride() > (n_open - 1e-6) * cell)
    {
      open(mesh, start + n_open * cell, start + (n_open + 1) * cell);
      solver.release(cell / drive.speed);
      ++n_open;
    }
    cut_energy += flank.cut_to(start + stride * drive.stride(), solver.sheet(), solver.displacement());
    solver.step();
    if (stride + CrackDrive::n_samples > drive.n_strides)
      add_sample(drive, sheet, medium, bonds, F, solver, drive.tip(stride), reach, run.field);
  }
  if (frame)
  {
    continuum::FieldWriter writer(MPI_COMM_SELF, frame->folder, frame->name);
    writer.add_frame(solver);
  }
  const continuum::EnergyLedger &end = solver.ledger();
  const double advance = 0.5 * (drive.n_strides - n_half) * drive.stride(); // of both halves
  run.energy = {(middle.stored + middle.kinetic - end.stored - end.kinetic) / advance,
                (end.dissipated - middle.dissipated) / advance, (end.released - middle.released + cut_energy) / advance,
                run.field.near_power() / drive.speed};
  return run;
}

} // namespace latcon::claims
