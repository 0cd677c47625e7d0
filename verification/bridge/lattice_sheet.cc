#include "verification/bridge/lattice_sheet.h"

#include "lattice/cutout.h"
#include "lattice/end_loads.h"

namespace latcon::bridge
{
namespace
{

using Condition = input::EdgeCase::Condition;

void check_edge(const input::EdgeCase &edge, input::Parameters &p, const std::string &command, bool may_roll)
{
  if (edge.condition == Condition::held && !(may_roll && edge.is_roller()) &&
      (edge.displacement.x != "loading" || edge.displacement.y != "loading"))
    p.error(edge.name + (edge.displacement.x != "loading" ? "/displacement x" : "/displacement y"),
            command + " supports held edges only at the homogeneous loading; give displacement = loading for " +
              (may_roll ? "one or both" : "both") + " components, or condition = free",
            {edge.name + "/condition"});
  if (!edge.traction.is_zero())
    p.error(edge.name + "/traction " + edge.traction.given(), command + " does not support tractions; give 0");
  if (!edge.double_traction.is_zero())
    p.error(edge.name + "/double traction " + edge.double_traction.given(),
            command + " does not support double tractions; give 0");
  // A layer of held sites at the loading has its normal gradient, for any condition of a gradient continuum.
  if (edge.normal_gradient == input::EdgeCase::NormalGradient::clamped)
    p.error(edge.name + "/normal gradient", command + " does not support clamped edges; give free or loading");
}

// Entries of the finite elements that have no counterpart.
void check_unused(const input::ContinuumCase &c, input::Parameters &p, const std::string &command, bool moves)
{
  if (!c.mesh_file.empty())
    p.error("Continuum/mesh file", command + " does not support a mesh file; the lattice fills a rectangle");
  if (!c.body_force.is_zero())
    p.error(std::string("Body force/force ") + c.body_force.given(), command + " does not support body forces; give 0");
  if (moves && c.initial_base != input::ContinuumCase::Base::loading)
    p.error("Initial state/base", command + " starts a motion from the homogeneous loading; give loading");
  for (const auto &[field, name] : {std::pair(&c.initial_displacement, std::string("Initial state/displacement")),
                                    std::pair(&c.initial_velocity, std::string("Initial state/velocity"))})
    if (moves && !field->is_zero())
      p.error(name + " " + field->given(), command + " starts a motion at rest, apart from noise; give 0");
}

} // namespace

void require_lattice_sheet(const input::Case &input, input::Parameters &p, const std::string &command)
{
  const input::ContinuumCase &c = input.continuum;
  const bool moves = input.solution == input::Case::Solution::motion;
  for (const input::EdgeCase &edge : c.edges)
    check_edge(edge, p, command, moves);
  if (!moves)
  {
    input::require_constant_loading(input, p, "static equilibrium has one loading");
    input::require_no_plasticity(input, p, "plastic stretch depends on the path, and static equilibrium has none");
  }
  else if (input.has_sheet() && (input.lattice().periodic().x || input.lattice().periodic().y))
    input::require_constant_loading(input, p, command + " keeps the period of a sheet");
  if (input.has_inner_edge() && c.edges[4].condition == Condition::held)
    p.error("Inner edge/condition", command + " leaves the rim of a hole or notch free; give free");
  check_unused(c, p, command, input.solution != input::Case::Solution::relaxed);
  if (input.solution == input::Case::Solution::relaxed) // a motion starts at the loading, with the deformed period
    c.require_equilibrium(p, input, command);
}

void require_fracture_case(const input::Case &input, input::Parameters &p)
{
  const std::string command = "`latcon fracture`";
  if (input.hole_radius > 0.)
    p.error("Sheet/hole radius", command + " does not support holes; give 0");
  if (input.notch_length > 0.)
    p.error("Sheet/notch length", command + " does not support notches; give 0");
  for (std::size_t id = 0; id < 4; ++id)
    if (input.continuum.edges[id].condition != Condition::held)
      p.error(input.continuum.edges[id].name + "/condition",
              command + " needs every edge of the sheet held; give held (free ends: Fracture/left end, right end)");
  for (std::size_t id = 0; id < 5; ++id)
    check_edge(input.continuum.edges[id], p, command, id == 2 || id == 3);
  check_unused(input.continuum, p, command, true);
  if (!input.breaking_stretch)
    p.error("Fracture/breaking stretch", "fracture needs a breaking stretch");
  if (!(input.end_time > 0.))
    p.error("Time/end", "fracture needs an end time larger than 0");
  const bool held_ends = input.left_end == input::Case::End::held && input.right_end == input::Case::End::held;
  const char *const end = input.left_end != input::Case::End::held ? "Fracture/left end" : "Fracture/right end";
  if (!held_ends)
    for (const std::size_t id : {2, 3})
      if (input.continuum.edges[id].is_roller())
        p.error(end, "the loads of an end are those of a sheet with held edges; give held",
                {input.continuum.edges[id].name + "/condition"});
  if (!held_ends && !input.history.empty())
    p.error(end, "the loads of an end are those of the loading at the start; with a history, give held",
            {"Loading/history times"});
  const bool absorbs = input.left_end == input::Case::End::absorbing || input.right_end == input::Case::End::absorbing;
  if (p.good() && absorbs && !lattice::waves_run_along_x(input.sheet(), input.material(), input.deformation()))
    p.error(input.left_end == input::Case::End::absorbing ? "Fracture/left end" : "Fracture/right end",
            "the loaded sheet buckles, so no waves propagate along x that an end could "
            "absorb; give held or free",
            {"Loading/strain x", "Loading/strain y"});
}

lattice::State lattice_state(const input::Case &input, const lattice::RowPartition &band)
{
  const auto held = [&](std::size_t id)
  { return input.continuum.edges[id].condition == Condition::held && !input.continuum.edges[id].is_roller(); };
  lattice::State state =
    lattice::homogeneous_state(band, input.material(), input.deformation(), {held(0), held(1), held(2), held(3)});
  if (input.has_inner_edge())
    lattice::cut_out(state, band.lattice(), {input.hole_radius, input.notch_length});
  return state;
}

} // namespace latcon::bridge
