#include "verification/input/case.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "lattice/chebyshev_stages.h"
#include "lattice/contact.h"
#include "lattice/seed.h"
#include "support/dense.h"
#include "support/full_precision.h"
#include "verification/input/sha256.h"

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

// More spacings along an edge exceed any sheet of rubber, and the integers of some indices.
constexpr double most_spacings = 1e6;
// More force evaluations per step gain nothing: the stable step grows as their square, limited by accuracy.
constexpr unsigned int most_stages = 200;

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
  if (input.breaking.rule == BreakingCase::Rule::bond_energy && !p.good())
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
            support::full_precision(longest) +
            " by the loading alone and would all break; give more than that, or less strain",
          {"Loading/strain x", "Loading/strain y", "Loading/shear"});
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

void check_relaxation_times(const Case &input, Parameters &p)
{
  std::vector<std::size_t> with_branches;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number) && !input.shell(number).relaxation_times.empty())
      with_branches.push_back(number);
  if (!p.good() || with_branches.empty())
    return;
  double step = input.lattice_time_stepping().step;
  if (input.breaking_stretch) // sites that touch require shorter steps, if they are automatic
    step = std::max(step, input.fracture_time_stepping().step);
  for (const std::size_t number : with_branches)
    input.shell(number).check_relaxation_times(
      p, Case::shell_sections[number], step,
      {"Time/step", "Time/integrator", "Time/stages", "Time/safety factor", "Sheet/spacing"});
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

void Case::declare(Parameters &p)
{
  p.add("Sheet", "spacing", spacing, Magnitude{}, "m", "lattice spacing d: undeformed distance between nearest sites",
        Presence::required);
  p.add("Sheet", "length", length, Magnitude{}, "m",
        "undeformed length along x, the direction of the crack; rounded to whole rows or columns of sites",
        Presence::required);
  p.add("Sheet", "height", height, Magnitude{}, "m",
        "undeformed height along y; rounded to whole rows or columns of sites", Presence::required);
  p.add("Sheet", "orientation", orientation,
        {{"rows-along-crack", lattice::Orientation::rows_along_crack},
         {"rows-across-crack", lattice::Orientation::rows_across_crack}},
        "orientation of the lattice: close-packed rows along x, or along y (rotated by 30 degrees)");

  p.add("Sheet", "hole radius", hole_radius, MagnitudeOrZero{}, "m",
        "undeformed radius of a circular hole in the centre of the sheet; 0: no hole");
  p.add("Sheet", "notch length", notch_length, MagnitudeOrZero{}, "m",
        "undeformed length of a slit from the left edge along y = 0; 0: no slit");

  p.add("Material", "density", density, Magnitude{}, "kg/m^3", "mass density rho of the rubber, undeformed",
        Presence::required);
  nearest.declare(p, shell_sections[0]);
  p.add(shell_sections[1], "present", has_next_nearest, "include bonds between next-nearest neighbours");
  next_nearest.declare(p, shell_sections[1]);
  p.add(shell_sections[2], "present", has_third_nearest,
        "include bonds of length 2 d, in the directions of the nearest neighbours");
  third_nearest.declare(p, shell_sections[2]);
  disorder.declare(p);

  p.add("Loading", "strain x", strain_x, Range({-1., false}, {1000., true}), "1",
        "eps_x: engineering strain along x; the stretch is 1 + eps_x", Presence::required);
  p.add("Loading", "strain y", strain_y, Range({-1., false}, {1000., true}), "1",
        "eps_y: engineering strain along y; the stretch is 1 + eps_y", Presence::required);

  p.add("Loading", "shear", shear, Between{-1000., 1000.}, "1", "F_xy: displacement along x over undeformed y");
  history.declare(p);

  p.add("Lattice", "solution", solution, {{"relaxed", Solution::relaxed}, {"motion", Solution::motion}},
        "what `latcon lattice` computes: static equilibrium, or the motion until the end time");
  p.add("Lattice", "noise amplitude", noise_amplitude, Between{0., 0.3}, "1",
        "amplitude of the uniform random initial displacement of each site along x and y, over d");
  p.add("Lattice", "noise seed", noise_seed, Any{}, "seed of the random displacements");

  p.add("Fracture", "breaking stretch", breaking_stretch, Range({1., false}, {1e6, true}), "1",
        "lam_f: bonds break irreversibly above this stretch; required by `latcon fracture`");
  breaking.declare(p);
  p.add("Fracture", "toughening", toughening,
        {{"none", Toughening::none}, {"behind-tip", Toughening::behind_tip}, {"retraction", Toughening::retraction}},
        "bonds whose lam_f is multiplied by the factor: none, bonds behind the tip, or bonds that have retracted");
  p.add("Fracture", "distance", toughening_distance, MagnitudeOrZero{}, "m",
        "delta: behind-tip toughens bonds whose undeformed midpoint is more than this behind the tip");
  p.add("Fracture", "fraction", toughening_fraction, Between{0.01, 0.999}, "1",
        "retraction toughens bonds whose stretch falls below this fraction of that in the loaded sheet");
  p.add("Fracture", "factor", toughening_factor, Between{1., 1e6}, "1",
        "toughened bonds break at this multiple of lam_f");
  p.add("Fracture", "seed shape", seed_shape, {{"sites", SeedShape::sites}, {"slit", SeedShape::slit}},
        "shape of the seed crack: a line of removed sites along x, or a rectangle of removed sites");
  p.add("Fracture", "seed sites", seed_sites, Between{1., 1000.}, "number of sites removed by the shape sites");
  p.add("Fracture", "seed length", seed_length, MagnitudeOrZero{}, "m", "undeformed length of the slit along x");
  p.add("Fracture", "seed height", seed_height, MagnitudeOrZero{}, "m", "undeformed height of the slit along y");
  p.add("Fracture", "seed position", seed_position, Between{0.01, 0.9}, "1",
        "position of the left end of the seed crack, as a fraction of the length");
  p.add("Fracture", "seed offset", seed_offset, Between{-1e20, 1e20}, "m",
        "undeformed y of the centre line of the seed crack; the shape sites uses the nearest line of sites");
  p.add("Fracture", "stop position", stop_position, Between{0.05, 0.99}, "1",
        "tip position at which the run ends, as a fraction of the length");
  const std::vector<std::pair<std::string, End>> ends{
    {"held", End::held}, {"free", End::free}, {"absorbing", End::absorbing}};
  p.add(
    "Fracture", "left end", left_end, ends,
    "left end: held at the loading, free under the dead load of the loaded sheet, or free with dashpots that absorb "
    "waves");
  p.add("Fracture", "right end", right_end, ends, "right end, as the left end");

  p.add("Contact", "present", has_contact,
        "include repulsion between sites of a breaking sheet that are close but not bonded");
  // Next-nearest neighbours of a lattice without bonds between them stand at 1.73 d.
  p.add("Contact", "distance", contact_distance, Range({1e-20, true}, {1.7, false}), "1",
        "distance below which sites are in contact, over d");
  p.add("Contact", "stiffness", contact_stiffness, Magnitude{}, "1",
        "stiffness of a contact over that of an undeformed nearest-neighbour bond");
  p.add("Contact", "viscosity", contact_viscosity, MagnitudeOrZero{}, "1",
        "viscosity of a contact over that of a nearest-neighbour bond");

  p.add("Time", "end", end_time, MagnitudeOrZero{}, "s", "latest end time of the motion");
  p.add("Time", "step", time_step, Magnitude{}, "s",
        "time step of the lattice; auto: the safety factor times the stability limit");
  p.add(
    "Time", "integrator", integrator,
    {{"velocity-verlet", Integrator::velocity_verlet}, {"runge-kutta-chebyshev", Integrator::runge_kutta_chebyshev}},
    "time integrator of the lattice: velocity Verlet, with a step limited by the viscosity, or longer steps of several "
    "stages");
  p.add("Time", "stages", stages, Between{0., most_stages},
        "number of force evaluations per step of runge-kutta-chebyshev, at least 2; 0: the smallest stable number");
  p.add(
    "Time", "safety factor", safety_factor, Between{0.01, 1.}, "1",
    "automatic time step over the limit that is stable in every configuration or, for runge-kutta-chebyshev, over the "
    "step that resolves the motion");

  continuum.declare(p);
  nonlocal.declare(p);

  p.add("Output", "frame interval", frame_interval, MagnitudeOrZero{}, "s",
        "time between full frames; 0: only the first and the last frame");
  p.add(
    "Output", "motion frames", motion_frames, Between{0., 1e4},
    "number of reduced frames of a crack for animations, equally spaced in tip position between the seed and the stop "
    "position; 0: none");
  p.add("Output", "energy interval", energy_interval, AtLeast{1.}, "number of time steps between rows of energy.csv");
  p.add("Checkpoints", "steps", checkpoint_steps, AtLeast{0.},
        "number of time steps between checkpoints of a motion; 0: not by steps");
  p.add("Checkpoints", "interval", checkpoint_interval, NonNegative{}, "s",
        "wall time between checkpoints of a motion; 0: not by time");

  p.add("Near tip", "ahead", near_tip_ahead, MagnitudeOrZero{}, "m",
        "undeformed length of the averaging window ahead of the tip; 0: 32 spacings");
  p.add("Near tip", "behind", near_tip_behind, MagnitudeOrZero{}, "m",
        "undeformed length of the averaging window behind the tip; 0: 40 spacings");
  p.add("Near tip", "half height", near_tip_half_height, MagnitudeOrZero{}, "m",
        "undeformed half height of the averaging window; 0: 32 spacings");
  p.add("Near tip", "interval", near_tip_interval, MagnitudeOrZero{}, "s",
        "time between samples of the fields near the tip; 0: no samples; auto: time in which a shear wave in the "
        "undeformed sheet travels half a spacing");

  p.add("Reference", "wavelength", reference_wavelength, Magnitude{}, "m",
        "published undeformed wavelength of the crack path, compared with the measured value; auto: none");
  p.add("Reference", "amplitude", reference_amplitude, Magnitude{}, "m",
        "published undeformed amplitude of the crack path, compared with the measured value; auto: none");
  p.add("Reference", "speed", reference_speed, Magnitude{}, "m/s",
        "published Lagrangian crack speed, compared with the measured value; auto: none");
  p.add("Reference", "tolerance", reference_tolerance, Magnitude{}, "1",
        "largest relative difference between measured and published values that counts as agreement");
}

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
  continuum.check(p, has_inner_edge());
  if (has_sheet())
  {
    const lattice::TriangularLattice sheet = lattice();
    continuum.check_values(p, {sheet.length(), sheet.height(), hole_radius, notch_length});
  }

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

std::vector<std::size_t> Case::seed(const lattice::TriangularLattice &lattice) const
{
  const double position = seed_position * lattice.length();
  if (seed_shape == SeedShape::slit)
    return lattice::seed_sites(lattice, lattice::SeedSlit{position, seed_offset, seed_length, seed_height});
  return lattice::seed_sites(lattice, lattice::SeedLine{position, seed_offset, seed_sites});
}

Case::Cut Case::seed_cut(const lattice::TriangularLattice &sheet) const
{
  const double from = seed_position * sheet.length();
  return {from, from + (seed_shape == SeedShape::slit ? seed_length : seed_sites * spacing),
          seed_offset + 0.25 * sheet.spacing()};
}

double Case::seed_tip(const lattice::TriangularLattice &sheet) const
{
  if (sheet.is_triangular())
    return sheet.reference(seed(sheet).back()).x();
  const Cut cut = seed_cut(sheet);
  if (!(cut.to - cut.from >= spacing))
    throw std::invalid_argument("the cut must be at least a spacing long");
  if (std::abs(seed_offset) > 0.5 * sheet.height() - 2. * spacing)
    throw std::invalid_argument("it comes within two spacings of the lower or the upper edge of the sheet");
  return cut.to;
}

bool Case::has_sheet() const
{
  const double shortest = std::min(length, height), longest = std::max(length, height);
  return spacing > 0. && shortest >= 8. * spacing && longest <= most_spacings * spacing;
}

lattice::TriangularLattice Case::lattice() const
{
  const auto periodic = [this](std::size_t edge)
  { return continuum.edges[edge].condition == EdgeCase::Condition::periodic; };
  return {spacing, length, height, orientation, {periodic(0), periodic(2)}};
}

lattice::Material Case::material() const
{
  lattice::Material material{density, nearest.shell(longest_stretch()), std::nullopt};
  if (has_next_nearest)
    material.next_nearest = next_nearest.shell(longest_stretch());
  if (has_third_nearest)
    material.third_nearest = third_nearest.shell(longest_stretch());
  material.disorder = disorder.disorder();
  return material;
}

double Case::longest_stretch() const
{
  if (breaking_stretch)
    return *breaking_stretch * breaking.largest_factor() * disorder.strength.distribution().largest() *
           (toughening == Toughening::none ? 1. : toughening_factor);
  constexpr double margin = 1.2;
  double longest = 1.;
  for (const Eigen::Matrix2d &F : history.deformations(deformation()))
    longest = std::max(longest, support::singular_values(F)(0));
  return margin * longest;
}

Eigen::Matrix2d Case::deformation() const
{
  Eigen::Matrix2d F;
  F << 1. + strain_x, shear, 0., 1. + strain_y;
  return F;
}

lattice::Toughening Case::toughening_rule() const
{
  switch (toughening)
  {
  case Toughening::behind_tip:
    return lattice::BehindTipToughening{toughening_distance, toughening_factor};
  case Toughening::retraction:
    return lattice::RetractionToughening{toughening_fraction, toughening_factor};
  default:
    return lattice::NoToughening{};
  }
}

std::string case_lines(const Parameters &parameters)
{
  std::string lines = parameters.lines("Checkpoints");
  const std::string mesh = parameters.value("Continuum/mesh file");
  if (std::error_code error; std::filesystem::is_regular_file(mesh, error))
    lines += "Continuum/mesh sha256 = " + sha256_of_file(mesh) + "\n";
  return lines;
}

} // namespace latcon::input
