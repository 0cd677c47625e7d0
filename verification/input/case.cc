#include "verification/input/case.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "lattice/contact.h"
#include "lattice/cutout.h"
#include "support/dense.h"
#include "verification/input/files.h"

namespace latcon::input
{

void Case::declare(Parameters &p)
{
  p.add("Sheet", "spacing", spacing, magnitude, "m", "lattice spacing d: undeformed distance between nearest sites",
        Presence::required)
    .read_by = ReadBy::claims;
  p.add("Sheet", "length", length, magnitude, "m",
        "undeformed length along x, the direction of the crack; rounded to whole rows or columns of sites",
        Presence::required);
  p.add("Sheet", "height", height, magnitude, "m",
        "undeformed height along y; rounded to whole rows or columns of sites", Presence::required);
  p.add("Sheet", "orientation", orientation,
        {{"rows-along-crack", lattice::Orientation::rows_along_crack},
         {"rows-across-crack", lattice::Orientation::rows_across_crack}},
        "orientation of the lattice: close-packed rows along x, or along y (rotated by 30 degrees)")
    .read_by = ReadBy::claims;

  p.add("Sheet", "hole radius", hole_radius, magnitude_or_zero, "m",
        "undeformed radius of a circular hole in the centre of the sheet; 0: no hole");
  p.add("Sheet", "notch length", notch_length, magnitude_or_zero, "m",
        "undeformed length of a slit from the left edge along y = 0; 0: no slit");

  p.add("Material", "density", density, magnitude, "kg/m^3", "mass density rho of the rubber, undeformed",
        Presence::required)
    .read_by = ReadBy::claims;
  nearest.declare(p, shell_sections[0]);
  p.add(shell_sections[1], "present", has_next_nearest, "include bonds between next-nearest neighbours").read_by =
    ReadBy::claims;
  next_nearest.declare(p, shell_sections[1]);
  p.add(shell_sections[2], "present", has_third_nearest,
        "include bonds of length 2 d, in the directions of the nearest neighbours")
    .read_by = ReadBy::claims;
  third_nearest.declare(p, shell_sections[2]);
  disorder.declare(p);

  p.add("Loading", "strain x", strain_x, Range({-1., false}, {1000., true}), "1",
        "eps_x: engineering strain along x; the stretch is 1 + eps_x", Presence::required)
    .read_by = ReadBy::claims;
  p.add("Loading", "strain y", strain_y, Range({-1., false}, {1000., true}), "1",
        "eps_y: engineering strain along y; the stretch is 1 + eps_y", Presence::required)
    .read_by = ReadBy::claims;

  p.add("Loading", "shear", shear, Range{-1000., 1000.}, "1", "F_xy: displacement along x over undeformed y").read_by =
    ReadBy::claims;
  history.declare(p);

  p.add("Lattice", "solution", solution, {{"relaxed", Solution::relaxed}, {"motion", Solution::motion}},
        "what `latcon lattice` computes: static equilibrium, or the motion until the end time");
  p.add("Lattice", "noise amplitude", noise_amplitude, Range{0., 0.3}, "1",
        "amplitude of the uniform random initial displacement of each site along x and y, over d");
  p.add("Lattice", "noise seed", noise_seed, any_number, "seed of the random displacements");

  p.add("Fracture", "breaking stretch", breaking_stretch, Range({1., false}, {1e6, true}), "1",
        "lam_f: bonds break irreversibly above this stretch; required by `latcon fracture`")
    .read_by = ReadBy::claims_on_user_laws;
  breaking.declare(p);
  p.add("Fracture", "toughening", toughening,
        {{"none", Toughening::none}, {"behind-tip", Toughening::behind_tip}, {"retraction", Toughening::retraction}},
        "bonds whose lam_f is multiplied by the factor: none, bonds behind the tip, or bonds that have retracted")
    .read_by = ReadBy::claims_on_user_laws;
  p.add("Fracture", "distance", toughening_distance, magnitude_or_zero, "m",
        "delta: behind-tip toughens bonds whose undeformed midpoint is more than this behind the tip");
  p.add("Fracture", "fraction", toughening_fraction, Range{0.01, 0.999}, "1",
        "retraction toughens bonds whose stretch falls below this fraction of that in the loaded sheet");
  p.add("Fracture", "factor", toughening_factor, Range{1., 1e6}, "1",
        "toughened bonds break at this multiple of lam_f (bond-energy: of the critical energy)")
    .read_by = ReadBy::claims_on_user_laws;
  p.add("Fracture", "seed shape", seed_shape, {{"sites", SeedShape::sites}, {"slit", SeedShape::slit}},
        "shape of the seed crack: a line of removed sites along x, or a rectangle of removed sites");
  p.add("Fracture", "seed sites", seed_sites, Range{1., 1000.}, "number of sites removed by the shape sites");
  p.add("Fracture", "seed length", seed_length, magnitude_or_zero, "m", "undeformed length of the slit along x");
  p.add("Fracture", "seed height", seed_height, magnitude_or_zero, "m", "undeformed height of the slit along y");
  p.add("Fracture", "seed position", seed_position, Range{0.01, 0.9}, "1",
        "position of the left end of the seed crack, as a fraction of the length");
  p.add("Fracture", "seed offset", seed_offset, Range{-1e20, 1e20}, "m",
        "undeformed y of the centre line of the seed crack; the shape sites uses the nearest line of sites");
  p.add("Fracture", "stop position", stop_position, Range{0.05, 0.99}, "1",
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
  p.add("Contact", "stiffness", contact_stiffness, magnitude, "1",
        "stiffness of a contact over that of an undeformed nearest-neighbour bond");
  p.add("Contact", "viscosity", contact_viscosity, magnitude_or_zero, "1",
        "viscosity of a contact over that of a nearest-neighbour bond");

  p.add("Time", "end", end_time, magnitude_or_zero, "s",
        "end of the motion; cracks, and given steps, pass it by less than a step");
  p.add("Time", "step", time_step, magnitude, "s",
        "time step of the lattice; auto: the safety factor times the stability limit");
  p.add(
    "Time", "integrator", integrator,
    {{"velocity-verlet", Integrator::velocity_verlet}, {"runge-kutta-chebyshev", Integrator::runge_kutta_chebyshev}},
    "time integrator of the lattice: velocity Verlet, with a step limited by the viscosity, or longer steps of several "
    "stages");
  p.add("Time", "stages", stages, Range{0., most_stages},
        "number of force evaluations per step of runge-kutta-chebyshev, at least 2; 0: the smallest stable number");
  p.add(
    "Time", "safety factor", safety_factor, Range{0.01, 1.}, "1",
    "automatic time step over the limit that is stable in every configuration or, for runge-kutta-chebyshev, over the "
    "step that resolves the motion");

  continuum.declare(p);
  nonlocal.declare(p);

  p.add("Output", "frame interval", frame_interval, magnitude_or_zero, "s",
        "time between full frames; 0: only the first and the last frame");
  p.add(
    "Output", "motion frames", motion_frames, Range{0., 1e4},
    "number of reduced frames of a crack for animations, equally spaced in tip position between the seed and the stop "
    "position; 0: none");
  p.add("Output", "energy interval", energy_interval, Range{1.}, "number of time steps between rows of energy.csv");
  p.add("Checkpoints", "steps", checkpoint_steps, Range{0.},
        "number of time steps between checkpoints of a motion; 0: not by steps");
  p.add("Checkpoints", "interval", checkpoint_interval, Range{0.}, "s",
        "wall time between checkpoints of a motion; 0: not by time");

  p.add("Near tip", "ahead", near_tip_ahead, magnitude_or_zero, "m",
        "undeformed length of the averaging window ahead of the tip; 0: 32 spacings");
  p.add("Near tip", "behind", near_tip_behind, magnitude_or_zero, "m",
        "undeformed length of the averaging window behind the tip; 0: 40 spacings");
  p.add("Near tip", "half height", near_tip_half_height, magnitude_or_zero, "m",
        "undeformed half height of the averaging window; 0: 32 spacings");
  p.add("Near tip", "interval", near_tip_interval, magnitude_or_zero, "s",
        "time between samples of the fields near the tip; 0: no samples; auto: time in which a shear wave in the "
        "undeformed sheet travels half a spacing");

  p.add("Reference", "wavelength", reference_wavelength, magnitude, "m",
        "published undeformed wavelength of the crack path, compared with the measured value; auto: none");
  p.add("Reference", "amplitude", reference_amplitude, magnitude, "m",
        "published undeformed amplitude of the crack path, compared with the measured value; auto: none");
  p.add("Reference", "speed", reference_speed, magnitude, "m/s",
        "published Lagrangian crack speed, compared with the measured value; auto: none");
  p.add("Reference", "tolerance", reference_tolerance, magnitude, "1",
        "largest relative difference between measured and published values that counts as agreement");
}

std::vector<std::size_t> Case::seed(const lattice::TriangularLattice &lattice) const
{
  const double position = seed_position * lattice.length();
  if (seed_shape == SeedShape::slit)
    return lattice::seed_slit(lattice, {position, seed_offset - 0.5 * seed_height},
                              {position + seed_length, seed_offset + 0.5 * seed_height});
  return lattice::seed_line(lattice, {position, seed_offset}, seed_sites);
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
    return {toughening_factor, 0., toughening_distance};
  case Toughening::retraction:
    return {toughening_factor, toughening_fraction};
  default:
    return {};
  }
}

lattice::ContactLaw Case::contact_law() const
{
  return lattice::contact_like_nearest_bond(sheet(), material(), contact_distance * spacing, contact_stiffness,
                                            contact_viscosity);
}

double Case::chebyshev_step(const bool breaks) const
{
  return safety_factor * lattice::chebyshev_step(sheet(), material(), smallest_chebyshev_stretch,
                                                 breaks && has_contact ? std::optional(contact_law()) : std::nullopt);
}

lattice::TimeStepping Case::time_stepping(const bool breaks) const
{
  const lattice::TimeStepLimits limits = time_step_limits(breaks);
  if (integrator == Integrator::velocity_verlet)
    return time_step ? *time_step : safety_factor * limits.combined;
  const double step = time_step ? *time_step : chebyshev_step(breaks);
  if (time_step && stages > 0)
    return {step, stages};
  return lattice::chebyshev_time_stepping(step, limits, stages);
}

lattice::TimeStepLimits Case::time_step_limits(const bool breaks) const
{
  Eigen::Matrix2d end_impedance = Eigen::Matrix2d::Zero();
  if (breaks && (left_end == End::absorbing || right_end == End::absorbing))
    end_impedance = lattice::end_impedance(sheet(), material(), deformation());
  return lattice::time_step_limits(sheet(), material(), smallest_stable_stretch,
                                   breaks && has_contact ? std::optional(contact_law()) : std::nullopt, end_impedance);
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
