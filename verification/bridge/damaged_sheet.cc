#include "verification/bridge/damaged_sheet.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "lattice/counter_hash.h"
#include "verification/bridge/lattice_sheet.h"

namespace latcon::bridge
{
namespace
{

using dealii::Point;
using dealii::Tensor;

constexpr double most_cells = 1e8; // of a grid; their indices and memory have room for them

// Directions of the fibres that stand for all directions, see continuum::in_all_directions(): an error of 1e-12 in a
// sheet at strains (1.3, 1.8), but of some percent where one stretch is ten times the other.
constexpr unsigned int n_directions = 12;

continuum::Rectangle rectangle(const input::Case &input, const continuum::DamageLaw &law)
{
  const double h = law.length / input.continuum.damage_cells;
  const lattice::TriangularLattice sheet = input.lattice();
  const auto cells_x = static_cast<unsigned int>(std::max(1., std::round(sheet.length() / h)));
  // Odd: the sheet then has a row of cells in the middle, which a crack opens, and is its own mirror image.
  const auto pairs = static_cast<unsigned int>(std::max(0., std::round((sheet.height() / h - 1.) / 2.)));
  return {sheet.length(), sheet.height(), cells_x, 2 * pairs + 1};
}

// Fibres and dashpots of the sheet: those of the lattice, or the same in all directions.
std::vector<continuum::FibreFamily> families(const input::Case &input, const Subject &subject)
{
  const std::vector<continuum::FibreFamily> &of_lattice = subject.cauchy_born.families();
  return input.continuum.law == input::ContinuumLaw::mooney_rivlin_network
           ? continuum::in_all_directions(of_lattice, n_directions)
           : of_lattice;
}

std::vector<continuum::FibreDashpot> dashpots(const input::Case &input, const Subject &subject)
{
  const auto viscosity = homogenised_viscosity(input.lattice(), subject.material);
  if (!viscosity)
    return {};
  const std::vector<continuum::FibreDashpot> &of_lattice =
    dynamic_cast<const continuum::FibreViscosity &>(*viscosity).dashpots();
  return input.continuum.law == input::ContinuumLaw::mooney_rivlin_network
           ? continuum::in_all_directions(of_lattice, n_directions)
           : of_lattice;
}

continuum::DamageMotionSetup setup(const input::Case &input, const Subject &subject, const continuum::DamageLaw &law,
                                   const continuum::Rectangle &sheet, const double step)
{
  const continuum::NodeGrid grid(sheet);
  continuum::DamageMotionSetup setup{sheet,
                                     to_continuum(input.deformation()),
                                     families(input, subject),
                                     dashpots(input, subject),
                                     input.density,
                                     law,
                                     {},
                                     {},
                                     step};
  const double length = sheet.length, top = 0.5 * sheet.height;
  // Distance from the nearest edge.
  const auto inside = [length, top](const Point<2> &X) {
    return std::min({X[0], length - X[0], top - X[1], top + X[1]});
  };
  const double on_edge = 1e-3 * std::min(grid.size_x, grid.size_y), near_edge = 2. * law.length;
  setup.is_held = [inside, on_edge](const Point<2> &X, unsigned int) { return inside(X) < on_edge; };
  setup.is_intact = [inside, near_edge](const Point<2> &X) { return inside(X) < near_edge; };
  if (input.continuum.gradient != input::ContinuumGradient::none)
  {
    std::vector<continuum::BondFamily> bonds = bond_families(input.lattice(), subject.material);
    if (input.continuum.gradient == input::ContinuumGradient::network)
      bonds = continuum::in_all_directions(bonds, n_directions);
    setup.gradient =
      continuum::GradientSetup{bonds, input.continuum.inertia_length.value_or(subject.lengths.lattice), true};
  }
  return setup;
}

// Random displacement of a point of the square lattice (i, j), in units of the amplitude.
Tensor<1, 2> noise_at(const double i, const double j, const std::uint64_t seed)
{
  const auto place = static_cast<std::uint64_t>(static_cast<std::int64_t>(i)) * 0x100000001ull +
                     static_cast<std::uint64_t>(static_cast<std::int64_t>(j));
  Tensor<1, 2> noise;
  for (const unsigned int axis : {0u, 1u})
  {
    const std::uint64_t bits = lattice::splitmix64(lattice::splitmix64(seed) ^ lattice::splitmix64(2 * place + axis));
    noise[axis] = std::ldexp(static_cast<double>(bits >> 11), -52) - 1.;
  }
  return noise;
}

// Reports a sheet that breaks everywhere at once: its homogeneous state is damaged.
void require_undamaged_loading(const input::Case &input, const DamagedSheet &sheet, input::Parameters &parameters)
{
  const double stored = continuum::CauchyBorn(families(input, sheet.subject)).energy(to_continuum(input.deformation()));
  if (stored < sheet.law.threshold)
    return;
  std::ostringstream text;
  text << "the loaded sheet stores " << stored << " J/m^3 and would be damaged everywhere, since damage begins at "
       << sheet.law.threshold << " J/m^3; give a larger threshold or a smaller strain";
  parameters.error("Damage/threshold energy", text.str(),
                   {"Loading/strain x", "Loading/strain y", "Fracture/breaking stretch"});
}

// Returns the longest of `step`, half of it, a quarter of it and so on for which `stages` does not throw InvalidInput:
// with little viscosity stages damp no waves in steps that velocity Verlet could take. Returns `step` if there is none.
double longest_accepted(double step, const std::function<unsigned int(double)> &stages)
{
  constexpr unsigned int most_halvings = 10;
  for (unsigned int n = 0; n <= most_halvings; ++n)
    try
    {
      (void)stages(std::ldexp(step, -static_cast<int>(n)));
      return std::ldexp(step, -static_cast<int>(n));
    }
    catch (const continuum::InvalidInput &)
    {
    }
  return step;
}

// Sets the time step and its stages, or reports why the sheet cannot move.
void set_stepping(const input::Case &input, DamagedSheet &sheet, input::Parameters &parameters)
{
  // The limits of a step depend on the cells, not on their number: three by three have an inner node and take no
  // memory.
  const continuum::Rectangle whole = rectangle(input, sheet.law);
  const continuum::Rectangle piece{3. * whole.length / whole.cells_x, 3. * whole.height / whole.cells_y, 3, 3};
  continuum::DamageMotionSetup probe = setup(input, sheet.subject, sheet.law, piece, 0.);
  probe.step = 1e-3 / continuum::FibreForces(continuum::NodeGrid(piece), probe.families, probe.dashpots, probe.loading)
                        .elastic_frequency(input.density);
  double stable = 0.;
  try
  {
    stable = continuum::DamageMotion(probe).stable_step();
  }
  catch (const continuum::InvalidInput &error)
  {
    // The step is short, and other entries have been checked.
    parameters.error(probe.gradient ? "Continuum/inertia length" : "Damage/cells per length", error.what(),
                     {"Damage/length"});
    return;
  }
  const auto stages = [&](double step)
  {
    probe.step = step;
    return continuum::DamageMotion(probe).n_stages();
  };
  sheet.automatic_step = longest_accepted(0.5 * stable, stages);
  sheet.step = input.continuum.time_step.value_or(sheet.automatic_step);
  try
  {
    sheet.stages = stages(sheet.step);
  }
  catch (const continuum::InvalidInput &error)
  {
    std::ostringstream text;
    text << error.what() << "; the longest explicit step of the loaded sheet without viscosity is " << stable << " s";
    parameters.error("Continuum/time step", text.str(), {"Damage/length", "Damage/cells per length"});
  }
}

} // namespace

continuum::DamageLaw damage_law(const input::Case &input, const Subject &subject)
{
  Tensor<2, 2> broken;
  broken[0][0] = broken[1][1] = input.breaking_stretch.value_or(3.);
  const input::ContinuumCase &c = input.continuum;
  return {c.damage_threshold ? *c.damage_threshold : subject.cauchy_born.energy(broken),
          c.damage_length.value_or(subject.spacing), c.residual_stiffness};
}

DamagedSheet damaged_sheet(const input::Case &input, input::Parameters &parameters)
{
  require_damaged_sheet(input, parameters);
  parameters.finish();
  DamagedSheet sheet{subject(input), {}, 0., 0., 0, 0.};
  sheet.law = damage_law(input, sheet.subject);
  require_undamaged_loading(input, sheet, parameters);
  set_stepping(input, sheet, parameters);
  parameters.finish();
  const continuum::Rectangle whole = rectangle(input, sheet.law);
  sheet.cells = static_cast<double>(whole.cells_x) * whole.cells_y;
  return sheet;
}

SeedSegment seed_segment(const input::Case &input, const continuum::NodeGrid &grid)
{
  const lattice::TriangularLattice sheet = input.lattice();
  const std::vector<std::size_t> sites = input.seed(sheet);
  SeedSegment seed{sheet.reference(sites.front()).x() - 0.5 * sheet.spacing(),
                   sheet.reference(sites.back()).x() + 0.5 * sheet.spacing(), 0.};
  for (const std::size_t site : sites)
    seed.Y += sheet.reference(site).y() / static_cast<double>(sites.size());
  seed.Y = grid.bottom + (std::floor((seed.Y - grid.bottom) / grid.size_y) + 0.5) * grid.size_y;
  return seed;
}

continuum::DamageMotion damage_motion(const input::Case &input, const DamagedSheet &sheet)
{
  continuum::DamageMotionSetup whole = setup(input, sheet.subject, sheet.law, rectangle(input, sheet.law), sheet.step);
  whole.communicator = MPI_COMM_WORLD;
  continuum::DamageMotion motion(whole);
  const continuum::NodeGrid &grid = motion.grid();
  const SeedSegment seed = seed_segment(input, grid);
  motion.set_damage(
    [&](const Point<2> &X)
    {
      // The nodes on both sides of the row of cells have the damage 1: its cells are open.
      const double x = std::max({seed.left - X[0], X[0] - seed.right, 0.});
      const double y = std::max(std::abs(X[1] - seed.Y) - 0.5 * grid.size_y, 0.);
      const double left = std::min(1. - std::hypot(x, y) / (2. * sheet.law.length), 1.);
      return left > 0. ? left * left : 0.;
    });
  const double spacing = input.spacing, amplitude = input.noise_amplitude * spacing;
  if (amplitude > 0.)
    motion.set_motion(
      [&](const Point<2> &X)
      {
        const double i = std::floor(X[0] / spacing), j = std::floor(X[1] / spacing);
        const double p = X[0] / spacing - i, q = X[1] / spacing - j;
        const auto at = [&](double k, double l) { return noise_at(k, l, input.noise_seed); };
        return amplitude * ((1. - q) * ((1. - p) * at(i, j) + p * at(i + 1., j)) +
                            q * ((1. - p) * at(i, j + 1.) + p * at(i + 1., j + 1.)));
      },
      [](const Point<2> &) { return Tensor<1, 2>(); });
  motion.settle_damage();
  return motion;
}

void require_damaged_sheet(const input::Case &input, input::Parameters &p)
{
  const std::string command = "`latcon fracture --side continuum`";
  const input::ContinuumCase &c = input.continuum;
  for (const auto &[end, name] :
       {std::pair(input.left_end, "Fracture/left end"), std::pair(input.right_end, "Fracture/right end")})
    if (end != input::Case::End::held)
      p.error(name, command + " holds both ends; give held");
  if (c.law == input::ContinuumLaw::mooney_rivlin)
    p.error("Continuum/law", command + " needs a law of fibres; give cauchy-born or mooney-rivlin-network");
  const bool is_network = c.law == input::ContinuumLaw::mooney_rivlin_network;
  if (c.gradient != input::ContinuumGradient::none &&
      c.gradient != (is_network ? input::ContinuumGradient::network : input::ContinuumGradient::lattice))
    p.error("Continuum/gradient",
            command + (is_network ? " supports none and, with this law, network"
                                  : " supports none and, with this law, lattice"),
            {"Continuum/law"});
  if (!c.mesh_file.empty())
    p.error("Continuum/mesh file", command + " makes its own mesh; omit the entry");
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
  {
    if (!input.has_shell(number))
      continue;
    const std::string section = input::Case::shell_sections[number];
    if (input.shell(number).has_user_law())
      p.error(section + "/law", command + " supports mooney-rivlin and linear");
    if (!input.shell(number).branch_moduli.empty())
      p.error(section + "/branch moduli", command + " does not support bonds with memory; give none");
  }
  for (const auto &[field, name] : {std::pair(&c.body_force, std::string("Body force/force")),
                                    std::pair(&c.initial_displacement, std::string("Initial state/displacement")),
                                    std::pair(&c.initial_velocity, std::string("Initial state/velocity"))})
    if (!field->is_zero())
      p.error(name + " " + field->given(), command + " does not support it; give 0");
  if (c.initial_base != input::ContinuumCase::Base::loading)
    p.error("Initial state/base", command + " starts from the homogeneous loading; give loading");
  if (input.disorder.strength.kind != lattice::Distribution::Kind::none)
    p.error("Disorder/strength", command + " does not support disorder; give none");
  if (input.disorder.stiffness.kind != lattice::Distribution::Kind::none)
    p.error("Disorder/stiffness", command + " does not support disorder; give none");
  const double h = c.damage_length.value_or(input.spacing) / c.damage_cells;
  if (p.good() && !(input.length / h * (input.height / h) <= most_cells))
    p.error("Damage/cells per length", "the mesh would have more than 1e8 cells",
            {"Damage/length", "Sheet/length", "Sheet/height"});
  if (p.good() && !(std::min(input.length, input.height) >= 8. * c.damage_length.value_or(input.spacing)))
    p.error("Damage/length", "the edges stay intact within 2 xi, so the sheet must be 8 xi high and long at least",
            {"Sheet/length", "Sheet/height"});
}

} // namespace latcon::bridge
