#include "verification/bridge/continuum_model.h"

#include <algorithm>

#include <deal.II/base/bounding_box.h>

#include "continuum/isotropic_gradient.h"
#include "continuum/lattice_gradient.h"
#include "continuum/meshes.h"
#include "continuum/network_gradient.h"
#include "support/errors.h"
#include "support/text_wrap.h"
#include "verification/bridge/affine_displacement.h"

namespace latcon::bridge
{
ContinuumModel::ContinuumModel(const input::Case &input)
  : subject_(bridge::subject(input)), law_(input.continuum.law), penalty_(input.continuum.penalty),
    mesh_(MPI_COMM_WORLD)
{
  if (input.continuum.law == input::ContinuumLaw::mooney_rivlin)
  {
    if (!subject_.mooney_rivlin)
      throw support::InputError(
        "Continuum/law: no plane-stress Mooney-Rivlin law has an equilibrium thickness along the whole loading path to "
        "Loading/strain x, strain y; give law = cauchy-born or mooney-rivlin-network" +
        std::string(input.continuum.mooney_rivlin_ratio ? ", or another Continuum/ratio" : ""));
    mooney_rivlin_.emplace(subject_.mooney_rivlin->law);
  }
  const lattice::TriangularLattice sheet = input.lattice();
  extent_ = std::min(sheet.length(), sheet.height());
  const GradientLengths lengths = gradient_lengths(sheet, subject_.material);
  using input::ContinuumGradient;
  const ContinuumGradient gradient = input.continuum.gradient;
  const double of_bonds = gradient == ContinuumGradient::isotropic ? lengths.isotropic_inertia : lengths.lattice;
  inertia_length_ = input.continuum.inertia_length.value_or(gradient == ContinuumGradient::none ? 0. : of_bonds);
  if (gradient == ContinuumGradient::isotropic)
  {
    static_length_ = input.continuum.static_length.value_or(lengths.isotropic_static);
    gradient_ = std::make_unique<continuum::IsotropicGradient>(subject_.theory.shear_modulus, static_length_);
  }
  else if (gradient == ContinuumGradient::lattice)
    gradient_ = std::make_unique<continuum::LatticeGradient>(bond_families(sheet, subject_.material), inertia_length_);
  else if (gradient == ContinuumGradient::network)
    gradient_ = std::make_unique<continuum::NetworkGradient>(bond_families(sheet, subject_.material), inertia_length_);
  make_mesh(input);
  make_conditions(input);
}

double ContinuumModel::viscous_gradient_length() const
{
  return dynamic_cast<const continuum::LatticeGradient *>(gradient_.get()) != nullptr ? inertia_length_ : 0.;
}

void ContinuumModel::make_mesh(const input::Case &input)
{
  // The lattice rounds its size to whole rows; use the rounded size, so that both sheets are the same.
  const lattice::TriangularLattice sheet = input.lattice();
  const input::ContinuumCase &c = input.continuum;
  const auto periodic = [&c](std::size_t edge)
  { return c.edges[edge].condition == input::EdgeCase::Condition::periodic; };
  if (!c.mesh_file.empty())
  {
    continuum::read_gmsh(mesh_, c.mesh_file, c.refinements);
    const auto [length, height] = mesh_extent();
    for (const double ratio : {length / sheet.length(), height / sheet.height()})
      if (!(ratio > 0.01 && ratio < 100.))
        throw support::InputError(
          support::text_of("the mesh file ", c.mesh_file, " spans ", length, " m x ", height,
                           " m, the sheet of the case ", sheet.length(), " m x ", sheet.height(),
                           " m; a mesh must be in metres, and Sheet/length and height of its order (0.01 to 100)"));
  }
  else if (input.hole_radius > 0.)
    continuum::make_rectangle_with_hole(mesh_, {sheet.length(), sheet.height(), input.hole_radius, c.refinements});
  else if (input.notch_length > 0.)
    continuum::make_notched_rectangle(mesh_, {sheet.length(), sheet.height(), input.notch_length, c.refinements});
  else
    continuum::make_rectangle(mesh_, {sheet.length(), sheet.height(), c.cells_x, c.cells_y, periodic(0), periodic(2)});
}

std::array<double, 2> ContinuumModel::mesh_extent() const
{
  // On this rank: of the coarse mesh, which all ranks hold.
  const dealii::BoundingBox<2> box(mesh_.get_vertices());
  return {box.side_length(0), box.side_length(1)};
}

void ContinuumModel::make_conditions(const input::Case &input)
{
  const input::ContinuumCase &c = input.continuum;
  const auto ids = mesh_.get_boundary_ids();
  const Eigen::Matrix2d F = input.deformation();
  for (dealii::types::boundary_id id = 0; id < c.edges.size(); ++id)
  {
    const input::EdgeCase &edge = c.edges[id];
    // A mesh from a file may lack edges; the inner edge exists only with a hole or a notch.
    const bool is_held = edge.condition == input::EdgeCase::Condition::held;
    if (std::find(ids.begin(), ids.end(), id) == ids.end())
    {
      if (!edge.traction.is_zero() || !edge.double_traction.is_zero() || (id == 4 && is_held))
        throw support::InputError("the mesh file " + c.mesh_file + " has no " + edge.name + ", which the case loads");
      continue;
    }
    if (is_held)
      conditions_.displacements.push_back(
        {id, std::make_shared<FieldFunction>(edge.displacement, extent_, F),
         dealii::ComponentMask(std::vector<bool>{edge.displacement.x != "free", edge.displacement.y != "free"})});
    if (edge.condition == input::EdgeCase::Condition::periodic)
    {
      if (id % 2 == 0)
        conditions_.periodic.push_back({id, id + 1u, id / 2u});
      continue;
    }
    if (edge.normal_gradient == input::EdgeCase::NormalGradient::clamped)
      conditions_.normal_gradients.push_back({id, std::make_shared<dealii::Functions::ZeroFunction<2>>(2)});
    if (edge.normal_gradient == input::EdgeCase::NormalGradient::loading)
    {
      // (F - I) N with the outward normal of an outer edge; the rim of a hole has no unique normal.
      const Eigen::Vector2d normals[4] = {{-1., 0.}, {1., 0.}, {0., -1.}, {0., 1.}};
      for (const auto &cell : mesh_.cell_iterators_on_level(0)) // of the coarse mesh, which all ranks hold
        for (const unsigned int face : cell->face_indices())
          if (const auto along = cell->face(face)->vertex(1) - cell->face(face)->vertex(0);
              cell->face(face)->boundary_id() == id &&
              std::abs(along[0] * normals[id].x() + along[1] * normals[id].y()) > 1e-6 * along.norm())
            throw support::InputError("the " + edge.name + " of the mesh file " + c.mesh_file + " is not parallel to " +
                                      "yx"[id / 2] + "; its normal gradient cannot be that of the loading");
      const Eigen::Vector2d slope = (F - Eigen::Matrix2d::Identity()) * normals[id];
      conditions_.normal_gradients.push_back(
        {id, std::make_shared<dealii::Functions::ConstantFunction<2>>(std::vector<double>{slope.x(), slope.y()})});
    }
    if (!edge.traction.is_zero())
      conditions_.tractions.push_back({id, std::make_shared<FieldFunction>(edge.traction, extent_)});
    if (!edge.double_traction.is_zero())
      conditions_.double_tractions.push_back({id, std::make_shared<FieldFunction>(edge.double_traction, extent_)});
  }
  for (const unsigned int axis : {0u, 1u})
    if (c.has_equilibrium() &&
        std::none_of(conditions_.displacements.begin(), conditions_.displacements.end(),
                     [axis](const continuum::BoundaryField &held) { return held.components[axis]; }))
      throw support::InputError("the mesh file " + c.mesh_file + " has none of the edges that the case holds along " +
                                "xy"[axis] + "; equilibrium needs one");
  if (!c.body_force.is_zero())
    conditions_.body_force = continuum::BodyForce{std::make_shared<FieldFunction>(c.body_force, extent_),
                                                  c.body_force_corrected ? inertia_length_ : 0.};
}

continuum::Constitution ContinuumModel::constitution() const
{
  const continuum::Material *law = &subject_.cauchy_born;
  if (law_ == input::ContinuumLaw::mooney_rivlin_network)
    law = &subject_.network;
  else if (law_ == input::ContinuumLaw::mooney_rivlin)
    law = &*mooney_rivlin_;
  continuum::Constitution constitution(*law);
  constitution.gradient = gradient_.get();
  constitution.penalty = penalty_;
  return constitution;
}

} // namespace latcon::bridge
