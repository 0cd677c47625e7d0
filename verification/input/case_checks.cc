#include "verification/input/case.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "lattice/chebyshev_stages.h"
#include "support/full_precision.h"

namespace latcon::input
{
namespace
{

void check_seed(const Case &input, Parameters &p, const lattice::TriangularLattice &sheet)
{
  const std::string extent =
    input.seed_shape == Case::SeedShape::sites ? "Fracture/seed sites" : "Fracture/seed length";
  const std::vector<std::string> others{"Fracture/seed position", "Fracture/seed offset", "Fracture/seed height",
                                        "Fracture/stop position", "Sheet/length",         "Sheet/height"};
  try
  {
    if (input.seed_tip(sheet) + sheet.spacing() > input.stop_position * sheet.length())
      p.error(extent, "the seed crack must end before the stop position", others);
  }
  catch (const std::invalid_argument &problem)
  {
    p.error(extent, std::string("the seed crack does not fit: ") + problem.what(), others);
  }
}

void check_size(const Case &input, Parameters &p)
{
  for (const auto &[key, extent, way] : {std::tuple("Sheet/height", input.height, " spacings high, "),
                                         std::tuple("Sheet/length", input.length, " spacings long, ")})
  {
    const std::string spacings = way;
    if (extent < 8. * input.spacing)
      p.error(key, "the sheet must be at least 8" + spacings + support::full_precision(8. * input.spacing) + " m",
              {"Sheet/spacing"});
    if (extent > most_spacings * input.spacing)
      p.error(
        key, "the sheet must be at most 1e6" + spacings + support::full_precision(most_spacings * input.spacing) + " m",
        {"Sheet/spacing"});
  }
}

void check_cutout(const Case &input, Parameters &p)
{
  if (input.hole_radius > 0. && input.notch_length > 0.)
    p.error("Sheet/notch length", "a sheet has a hole or a notch, not both", {"Sheet/hole radius"});
  const double widest = 0.45 * std::min(input.length, input.height);
  if (input.hole_radius >= widest)
    p.error("Sheet/hole radius",
            "it must be less than 0.45 of the sheet's length and height, " + support::full_precision(widest) + " m",
            {"Sheet/length", "Sheet/height"});
  if (input.notch_length >= input.length && input.notch_length > 0.)
    p.error("Sheet/notch length",
            "it must be less than the sheet's length, " + support::full_precision(input.length) + " m",
            {"Sheet/length"});
  for (const auto &[key, extent] :
       {std::pair("Sheet/hole radius", input.hole_radius), std::pair("Sheet/notch length", input.notch_length)})
    if (extent > 0. && extent < input.spacing)
      p.error(key, "it must be at least a spacing, " + support::full_precision(input.spacing) + " m, or 0",
              {"Sheet/spacing"});
}

// Reports a breaking stretch at which the loading alone would break bonds.
void check_breaking_stretch(const Case &input, Parameters &p, const lattice::TriangularLattice &sheet)
{
  if (input.breaking.needs_energy() && !p.good())
    return; // bonds may have no energy
  const std::shared_ptr<const lattice::BreakingRule> rule = input.breaking_rule();
  double longest = 0., over_limit = 0.;
  std::size_t of_kind = 0;
  for (std::size_t kind = 0; kind < sheet.n_kinds(); ++kind)
  {
    if (!input.has_shell(sheet.shell(kind)))
      continue;
    const Eigen::Vector2d R = sheet.bond_vector(kind);
    const double stretch = (input.deformation() * R).norm() / R.norm();
    const double ratio = stretch / rule->limit({sheet.shell(kind)});
    // Equal ratios differ by rounding.
    if (ratio > over_limit * (1. + 1e-12))
    {
      longest = stretch;
      over_limit = ratio;
      of_kind = kind;
    }
  }
  if (over_limit < 1.)
    return;
  const Eigen::Vector2d R = sheet.bond_vector(of_kind);
  p.error("Fracture/breaking stretch",
          std::string(lattice::shell_names[sheet.shell(of_kind)]) + "-neighbour bonds at " +
            std::to_string(std::lround(std::atan2(R.y(), R.x()) * 180. / M_PI)) + " degrees to x are stretched to " +
            support::full_precision(longest) + " by the loading alone, where their limit is " +
            support::full_precision(longest / over_limit) +
            ", and would all break; give a larger limit, or less strain",
          {"Fracture/rule", "Fracture/shell factors", "Loading/strain x", "Loading/strain y", "Loading/shear"});
}

// Entries of the viscosities of the shells, and others.
std::vector<std::string> viscosities_and(const Case &input, const std::vector<std::string> &others)
{
  std::vector<std::string> entries;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number))
      entries.push_back(std::string(Case::shell_sections[number]) + "/viscosity");
  entries.insert(entries.end(), others.begin(), others.end());
  return entries;
}

// Reports a time step for which the dashpots require more stages than are allowed.
void check_stages(const Case &input, Parameters &p)
{
  if (input.stages > 0)
    return;
  const bool breaks = input.breaking_stretch.has_value();
  const lattice::TimeStepLimits limits = input.time_step_limits(breaks);
  const double longest = lattice::ChebyshevStages(most_stages).real_limit() * limits.viscous;
  const double step = input.time_step ? *input.time_step : input.chebyshev_step(breaks);
  if (!(step <= longest))
    p.error("Time/step",
            "the viscosity limits runge-kutta-chebyshev to steps of " + support::full_precision(longest) + " s with " +
              std::to_string(most_stages) + " stages; this step is " + support::full_precision(step) + " s",
            viscosities_and(input, {"Contact/viscosity", "Sheet/spacing", "Time/integrator"}));
}

// Reports a given time step with which the oscillation of two sites in contact grows.
void check_contact_step(const Case &input, Parameters &p)
{
  if (input.breaking_stretch && input.has_contact &&
      lattice::amplifies_contact(input.fracture_time_stepping(), input.sheet(), input.material(),
                                 input.contact_law()))
    p.error("Time/step", "two sites in contact would gain energy in every step; omit `step`, or give a smaller one",
            {"Contact/stiffness", "Contact/viscosity", "Time/integrator", "Time/stages"});
}

// Twice the bound on the dashpots is where the undeformed lattice of nearest neighbours is certain to be unstable.
void check_time_step(const Case &input, Parameters &p)
{
  const lattice::TimeStepLimits limits = lattice::time_step_limits(input.sheet(), input.material(), 1.);
  double limit = 2. * limits.combined;
  if (input.integrator == Case::Integrator::runge_kutta_chebyshev)
  {
    if (input.stages < 2)
      return;
    limit = 2. * lattice::ChebyshevStages(input.stages).real_limit() * limits.viscous;
  }
  if (*input.time_step > limit)
    p.error("Time/step",
            "the time stepping is unstable beyond " + support::full_precision(limit) +
              " s; omit `step`, or give a smaller one",
            viscosities_and(input, {"Sheet/spacing", "Time/integrator", "Time/stages"}));
}

// Returns whether all shells that the case has fulfil a condition.
template <class Condition>
bool all_shells(const Case &input, const Condition &condition)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number) && !condition(input.shell(number)))
      return false;
  return true;
}

void check_relaxation_times(const Case &input, Parameters &p)
{
  if (!p.good() || all_shells(input, [](const ShellCase &shell) { return shell.relaxation_times.empty(); }))
    return;
  double step = input.lattice_time_stepping().step;
  if (input.breaking_stretch) // sites that touch require shorter steps, if they are automatic
    step = std::max(step, input.fracture_time_stepping().step);
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number))
      input.shell(number).check_relaxation_times(
        p, Case::shell_sections[number], step,
        {"Time/step", "Time/integrator", "Time/stages", "Time/safety factor", "Sheet/spacing"});
}

// Reports a user-defined law without values where a bond can be before it breaks: beyond the breaking stretch by what a
// bond gains within a time step.
void check_laws_within_a_step(const Case &input, Parameters &p)
{
  if (!input.breaking_stretch || !p.good())
    return;
  const double longest = input.longest_stretch();
  const double gain =
    input.fracture_time_stepping().step * lattice::largest_stretch_rate(input.sheet(), input.material(), longest);
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number) && input.shell(number).has_user_law())
      try
      {
        (void)input.shell(number).shell(longest + gain);
      }
      catch (const UserLaw::Problem &problem)
      {
        const std::string section = Case::shell_sections[number];
        p.error(section + "/" + problem.entry,
                "a bond can be longer by " + support::full_precision(gain) +
                  " than its breaking stretch before the time step ends in which it breaks: " + problem.what(),
                {section + "/law", "Fracture/breaking stretch", "Fracture/factor", "Time/step"});
      }
}

void check_time_stepping(const Case &input, Parameters &p)
{
  const bool chebyshev = input.integrator == Case::Integrator::runge_kutta_chebyshev;
  if (!chebyshev && input.stages != 0)
    p.error("Time/stages", "velocity-verlet has no stages; give 0, or integrator = runge-kutta-chebyshev",
            {"Time/integrator"});
  if (chebyshev && input.stages == 1)
    p.error("Time/stages", "a second-order method has at least two stages; give 0 for an automatic number");
  if (chebyshev && !all_shells(input, [](const ShellCase &shell) { return shell.viscosity != 0.; }))
    p.error("Time/integrator", "runge-kutta-chebyshev requires a viscosity for all bonds; give one, or velocity-verlet",
            viscosities_and(input, {}));
  else if (chebyshev && input.breaking_stretch && input.has_contact && input.contact_viscosity == 0.)
    p.error("Contact/viscosity",
            "runge-kutta-chebyshev amplifies undamped oscillations, also in contacts; give more than 0, or "
            "integrator = velocity-verlet",
            {"Time/integrator"});
  else if (input.density > 0. && input.has_sheet() &&
           all_shells(input, [](const ShellCase &shell) { return shell.has_stiffness(); }))
  {
    if (chebyshev)
      check_stages(input, p);
    if (input.time_step)
    {
      check_time_step(input, p);
      check_contact_step(input, p);
    }
    check_relaxation_times(input, p);
    check_laws_within_a_step(input, p);
  }
}

} // namespace

void Case::check(Parameters &p)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (has_shell(number))
      shell(number).check(p, shell_sections[number], longest_stretch());
  disorder.check(p);
  history.check(p);
  breaking.check(*this, p);

  check_size(*this, p);
  check_cutout(*this, p);
  if (has_inner_edge() && !continuum.mesh_file.empty())
    p.error("Continuum/mesh file", "a mesh from a file has its own holes; give hole radius = 0 and notch length = 0",
            {"Sheet/hole radius", "Sheet/notch length"});
  continuum.check(p, *this);

  for (const auto &[name, extent] : {std::pair{"ahead", near_tip_ahead}, std::pair{"behind", near_tip_behind},
                                     std::pair{"half height", near_tip_half_height}})
    if (extent != 0. && (extent < spacing || extent > std::max(length, height)))
      p.error(std::string("Near tip/") + name, "it must be at least a spacing and no more than the sheet, or 0",
              {"Sheet/spacing", "Sheet/length", "Sheet/height"});

  nonlocal.check(*this, p);
  if (nonlocal.is_used && !p.good())
    return; // there may be no sheet
  if (breaking_stretch && has_sheet())
  {
    const lattice::TriangularLattice moving = sheet();
    check_breaking_stretch(*this, p, moving);
    check_seed(*this, p, moving);
  }
  if (toughening != Toughening::none && toughening_factor == 1.)
    p.error("Fracture/factor",
            "toughening by a factor of 1 changes nothing; give a larger factor, or toughening = none",
            {"Fracture/toughening"});
  check_time_stepping(*this, p);
}

} // namespace latcon::input
