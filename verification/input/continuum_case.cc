#include <algorithm>
#include <cmath>
#include <memory>

#include "verification/input/case.h"
#include "verification/input/expression_parser.h"

namespace latcon::input
{
namespace
{

using Points = FieldCase::Points;

// Returns whether the extent of the sheet is known; that of a mesh from a file only after reading it.
bool has_extent(const Case &input)
{
  return input.has_sheet() && input.continuum.mesh_file.empty();
}

// Points on an edge of the sheet, its ends among them, and those where cells of most numbers meet.
Points points_on(const std::size_t edge, const Case &input)
{
  Points points;
  if (!has_extent(input))
    return points;
  constexpr unsigned int n = 720;
  const lattice::TriangularLattice sheet = input.lattice();
  for (unsigned int i = 0; i <= n; ++i)
  {
    const double part = static_cast<double>(i) / n;
    const double X = part * sheet.length(), Y = (part - 0.5) * sheet.height(), angle = 2. * M_PI * part;
    if (edge < 2)
      points.push_back({edge == 0 ? 0. : sheet.length(), Y});
    else if (edge < 4)
      points.push_back({X, (edge == 2 ? -0.5 : 0.5) * sheet.height()});
    else if (input.hole_radius > 0.)
      points.push_back(
        {0.5 * sheet.length() + input.hole_radius * std::cos(angle), input.hole_radius * std::sin(angle)});
    else if (input.notch_length > 0.)
      points.push_back({part * input.notch_length, 0.});
  }
  return points;
}

// Points all over the sheet, its edges among them.
Points points_in(const Case &input)
{
  Points points;
  if (!has_extent(input))
    return points;
  constexpr unsigned int n = 48;
  const lattice::TriangularLattice sheet = input.lattice();
  for (unsigned int i = 0; i <= n; ++i)
    for (unsigned int j = 0; j <= n; ++j)
    {
      const double X = sheet.length() * i / n, Y = sheet.height() * (static_cast<double>(j) / n - 0.5);
      if (std::hypot(X - 0.5 * sheet.length(), Y) >= input.hole_radius)
        points.push_back({X, Y});
    }
  return points;
}

} // namespace

void FieldCase::declare(Parameters &p, const std::string &section, const std::string &name, const std::string &unit,
                        const std::string &documentation, const std::string &values)
{
  for (std::string *component : {&x, &y})
    p.add(section, name + (component == &x ? " x" : " y"), *component,
          documentation + ", component " + (component == &x ? "x" : "y") + " [" + unit + "]: " + values);
}

void FieldCase::check(Parameters &p, const std::string &section, const std::string &name, const Points &points,
                      const std::vector<std::string> &words) const
{
  for (const std::string *text : {&x, &y})
  {
    // The most frequent value is excluded because constructing a parser is slow.
    if (*text == "0" || std::find(words.begin(), words.end(), *text) != words.end())
      continue;
    if (const std::string problem = problem_with_field(*text, points); !problem.empty())
      p.error(section + "/" + name + (text == &x ? " x" : " y"), problem);
  }
}

std::function<double(unsigned int, double, double)> FieldCase::field(const Eigen::Matrix2d &F) const
{
  const auto component = [&F](const std::string &text, int i) -> std::function<double(double, double)>
  {
    if (text == "loading")
      return [a = F(i, 0), b = F(i, 1), i](double X, double Y) { return a * X + b * Y - (i == 0 ? X : Y); };
    return [expression = std::make_shared<FieldExpression>(text == "free" ? "0" : text)](double X, double Y)
    { return (*expression)(X, Y); };
  };
  return [components = std::array{component(x, 0), component(y, 1)}](unsigned int i, double X, double Y)
  { return components[i](X, Y); };
}

void EdgeCase::declare(Parameters &p, const bool can_be_periodic)
{
  std::vector<std::pair<std::string, Condition>> words = {{"held", Condition::held}, {"free", Condition::free}};
  if (can_be_periodic)
    words.emplace_back("periodic", Condition::periodic);
  p.add(name, "condition", condition, words,
        "boundary condition: held (displacement prescribed), free (traction prescribed)" +
          std::string(can_be_periodic ? ", periodic with the opposite edge" : ""));
  displacement.declare(p, name, "displacement", "m", "prescribed displacement of a held edge",
                       "`loading` for the homogeneous loading, `free`, or an expression in x, y [m] and pi");
  p.add(
    name, "normal gradient", normal_gradient,
    {{"free", NormalGradient::free}, {"clamped", NormalGradient::clamped}, {"loading", NormalGradient::loading}},
    "normal derivative of the displacement, for gradient laws: free, clamped to zero, or prescribed by the homogeneous "
    "loading");
  traction.declare(p, name, "traction", "Pa", "dead load per undeformed area");
  double_traction.declare(p, name, "double traction", "Pa m",
                          "dead load conjugate to the normal derivative of the displacement");
}

void EdgeCase::check(Parameters &p, const FieldCase::Points &points) const
{
  displacement.check(p, name, "displacement", points, {"loading", "free"});
  traction.check(p, name, "traction", points);
  double_traction.check(p, name, "double traction", points);
  if (condition == Condition::held && displacement.x == "free" && displacement.y == "free")
    p.error(name + "/condition", "a held edge needs a displacement that is not `free`, or condition = free");
  // A given load must have an effect: on a held edge for a free component only, on a periodic edge never.
  for (const bool is_x : {true, false})
  {
    const std::string &given = is_x ? displacement.x : displacement.y;
    if ((is_x ? traction.x : traction.y) != "0" && condition != Condition::free &&
        (condition == Condition::periodic || given != "free"))
      p.error(name + (is_x ? "/traction x" : "/traction y"), "a traction needs an edge that is free to move that way",
              {name + "/condition"});
    if (condition != Condition::held && given != "loading" && given != "free")
      p.error(name + (is_x ? "/displacement x" : "/displacement y"), "a displacement needs an edge that is held",
              {name + "/condition"});
  }
  if (condition == Condition::periodic && normal_gradient != NormalGradient::free)
    p.error(name + "/normal gradient", "that of a periodic edge follows from the opposite one", {name + "/condition"});
  if (!double_traction.is_zero() && (condition == Condition::periodic || normal_gradient != NormalGradient::free))
    p.error(name + "/double traction " + double_traction.given(),
            "a double traction needs an edge whose normal gradient is free",
            {name + "/condition", name + "/normal gradient"});
}

void ContinuumCase::declare(Parameters &p)
{
  p.add("Continuum", "law", law,
        {{"cauchy-born", ContinuumLaw::cauchy_born},
         {"mooney-rivlin-network", ContinuumLaw::mooney_rivlin_network},
         {"mooney-rivlin", ContinuumLaw::mooney_rivlin}},
        "material law of the finite element sheet: Cauchy-Born law of the lattice, its mean over all bond directions, "
        "or the plane-stress Mooney-Rivlin law calibrated along the loading path");
  p.add("Continuum", "ratio", mooney_rivlin_ratio, Range{-0.9, 0.9}, "1",
        "r = C2 / (C1 + C2) of the law mooney-rivlin; auto: calibrated along the loading path")
    .read_by = ReadBy::claims;
  p.add("Continuum", "gradient", gradient,
        {{"none", ContinuumGradient::none},
         {"isotropic", ContinuumGradient::isotropic},
         {"lattice", ContinuumGradient::lattice},
         {"network", ContinuumGradient::network}},
        "strain-gradient energy: none, (mu l_s^2 / 2) |Grad F|^2, the energy of the lattice's bonds, or its mean over "
        "all bond "
        "directions, for the law mooney-rivlin-network");
  p.add("Continuum", "static length", static_length, magnitude_or_zero, "m",
        "l_s of the isotropic gradient energy; auto: fitted to the direction-averaged dispersion of the lattice");
  p.add("Continuum", "inertia length", inertia_length, magnitude_or_zero, "m",
        "l_d of the micro-inertia and of the gradient energies lattice and network; auto: 0 without a gradient energy, "
        "fitted together with l_s for isotropic, the longest bond over sqrt(12) for the others");
  p.add("Continuum", "penalty", penalty, Range{0.1, 1000.}, "1",
        "gamma: penalty gamma p (p + 1) / h on jumps of the normal derivative");
  p.add("Continuum", "cells x", cells_x, Range{1., 65536.}, "number of cells along x of a sheet without hole or notch");
  p.add("Continuum", "cells y", cells_y, Range{1., 65536.}, "number of cells along y of a sheet without hole or notch");
  p.add("Continuum", "refinements", refinements, Range{0., 12.},
        "number of uniform refinements of the mesh of a sheet with a hole or a notch, or of a mesh from a file");
  p.add("Continuum", "mesh file", mesh_file,
        "Gmsh mesh of quadrilaterals [m] that replaces the sheet; physical curves named left, right, bottom, top, "
        "inner, or without names 0 to 4");
  p.add("Continuum", "degree", degree, Range{1., 5.},
        "polynomial degree p of the elements; at least 2 with a gradient energy");
  p.add("Continuum", "adaptive cycles", adaptive_cycles, Range{0., 30.},
        "number of adaptive mesh refinements after the loading");
  p.add("Continuum", "refined fraction", refined_fraction, Range{0.001, 1.}, "1",
        "fraction of the cells refined in each adaptive cycle");
  p.add("Continuum", "reaction tolerance", reaction_tolerance, magnitude, "1",
        "largest relative change of the largest reaction in the last adaptive cycle that counts as converged; "
        "auto: the change is reported without a verdict");
  p.add("Continuum", "first load step", first_load_step, Range{0.001, 1.}, "1", "first increment of the load factor");
  p.add("Continuum", "relative tolerance", relative_tolerance, Range{1e-14, 1e-4}, "1",
        "relative residual at which Newton's method stops, not below its round-off");
  p.add("Continuum", "direct limit", direct_limit, Range{0., 1e7},
        "largest number of unknowns for the direct solver, which periodic sheets always use; above it multigrid with "
        "conjugate gradients or, with viscosity or Maxwell branches, GMRES");
  p.add("Continuum", "solution", solution, {{"equilibrium", Solution::equilibrium}, {"motion", Solution::motion}},
        "what `latcon continuum` computes: static equilibrium, or the motion until the end time");
  p.add(
    "Continuum", "time step", time_step, magnitude, "s",
    "time step of the motion; auto: half the time in which a longitudinal wave crosses a cell, at most a tenth of the "
    "shortest relaxation time");
  p.add("Continuum", "rule", rule,
        {{"average-acceleration", Rule::average_acceleration}, {"generalised-alpha", Rule::generalised_alpha}},
        "time integration scheme");
  p.add("Continuum", "spectral radius", spectral_radius, Range{0., 1.}, "1",
        "spectral radius of generalised-alpha at high frequencies: 1 conserves their energy, 0 removes it in one step");
  for (std::size_t id = 0; id < edges.size(); ++id)
    edges[id].declare(p, id < 4);
  body_force.declare(p, "Body force", "force", "N/m^3", "dead load per undeformed volume of the finite element sheet");
  p.add("Body force", "corrected", body_force_corrected,
        "apply (1 - l_d^2 Laplace) to the force, as required to match the lattice with micro-inertia");
  p.add(
    "Initial state", "base", initial_base,
    {{"undeformed", Base::undeformed}, {"loading", Base::loading}, {"equilibrium", Base::equilibrium}},
    "initial state of a motion of the finite elements: undeformed, homogeneously loaded, or in equilibrium with the "
    "boundary conditions");
  initial_displacement.declare(p, "Initial state", "displacement", "m",
                               "initial displacement added to the base, zero on held edges");
  initial_velocity.declare(p, "Initial state", "velocity", "m/s", "initial velocity of the finite elements");
}

void ContinuumCase::check(Parameters &p, const Case &input) const
{
  const bool has_inner_edge = input.has_inner_edge();
  if (gradient != ContinuumGradient::none && degree < 2)
    p.error("Continuum/degree", "a gradient energy needs elements of degree 2 or more", {"Continuum/gradient"});
  const bool has_gradient =
    gradient != ContinuumGradient::none && !(gradient == ContinuumGradient::isotropic && static_length == 0.);
  for (std::size_t id = 0; id < edges.size(); ++id)
  {
    const EdgeCase &edge = edges[id];
    edge.check(p, points_on(id, input));
    if (!has_gradient && edge.normal_gradient != EdgeCase::NormalGradient::free)
      p.error(edge.name + "/normal gradient", "without a gradient energy it cannot be held", {"Continuum/gradient"});
    if (!has_gradient && !edge.double_traction.is_zero())
      p.error(edge.name + "/double traction " + edge.double_traction.given(), "without a gradient energy there is none",
              {"Continuum/gradient"});
  }
  for (const std::size_t id : {0, 2})
    if ((edges[id].condition == EdgeCase::Condition::periodic) !=
        (edges[id + 1].condition == EdgeCase::Condition::periodic))
      p.error(edges[id].name + "/condition", "opposite edges must both be periodic, or neither",
              {edges[id + 1].name + "/condition"});
  if (!mesh_file.empty() || has_inner_edge)
    for (const std::size_t id : {0, 2})
      if (edges[id].condition == EdgeCase::Condition::periodic)
        p.error(edges[id].name + "/condition", "only a sheet without hole, notch and mesh file can be periodic");
  if (solution == Solution::motion && adaptive_cycles > 0)
    p.error("Continuum/adaptive cycles", "the mesh of a motion is not refined; give 0", {"Continuum/solution"});
  if (solution == Solution::motion && time_step && input.end_time > 0. && *time_step > input.end_time)
    p.error("Continuum/time step", "a step is longer than the motion; give at most Time/end", {"Time/end"});
  if (const EdgeCase &inner = edges[4];
      !has_inner_edge && mesh_file.empty() &&
      (inner.condition != EdgeCase::Condition::free || inner.normal_gradient != EdgeCase::NormalGradient::free ||
       !inner.traction.is_zero() || !inner.double_traction.is_zero()))
    p.error(inner.name + (inner.traction.is_zero() ? "/condition" : std::string("/traction ") + inner.traction.given()),
            "the sheet has neither hole nor notch; omit the entries of the inner edge",
            {"Sheet/hole radius", "Sheet/notch length"});
  if (edges[4].normal_gradient == EdgeCase::NormalGradient::loading)
    p.error("Inner edge/normal gradient", "an inner edge has no single normal; give free or clamped");
  const Points inside = points_in(input);
  body_force.check(p, "Body force", "force", inside);
  initial_displacement.check(p, "Initial state", "displacement", inside);
  initial_velocity.check(p, "Initial state", "velocity", inside);
}

void ContinuumCase::require_equilibrium(Parameters &p, const Case &input, const std::string &command) const
{
  std::string loose;
  for (const std::size_t axis : {0, 1})
    if (std::none_of(edges.begin(), edges.end(),
                     [axis](const EdgeCase &edge)
                     {
                       const FieldCase &given = edge.displacement;
                       return edge.condition == EdgeCase::Condition::held && (axis == 0 ? given.x : given.y) != "free";
                     }))
      loose += (loose.empty() ? "" : " and ") + std::string(1, "xy"[axis]);
  if (!loose.empty())
    p.error("Left edge/condition", command + " needs edges that are held along " + loose + " for equilibrium",
            {"Right edge/condition", "Bottom edge/condition", "Top edge/condition"});
  const std::string period = command + " keeps the undeformed period of a sheet in equilibrium; give 0";
  if (edges[0].condition == EdgeCase::Condition::periodic && input.strain_x != 0.)
    p.error("Loading/strain x", period, {"Left edge/condition"});
  if (edges[2].condition == EdgeCase::Condition::periodic && (input.strain_y != 0. || input.shear != 0.))
    p.error(input.strain_y != 0. ? "Loading/strain y" : "Loading/shear", period, {"Bottom edge/condition"});
}

} // namespace latcon::input
