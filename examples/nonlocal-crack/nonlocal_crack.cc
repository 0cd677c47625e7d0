// The crack of Fig. 1 in a nonlocal continuum: its bonds in all directions, or in arcs about the lattice's six, on a
// grid of any spacing. Prints the path of the tip, then speed, rms of the path and energies per length.
//
//   nonlocal_crack [NAME=VALUE...]
//
//   grid=triangular|square  m=2                   spacing d/m
//   rows=along|across                             the crack, of the grid and of the six directions
//   half-width=30                                 of the arcs [degrees]; 0 with m=1 on the triangular grid: the lattice
//   horizon=1                                     lengths of the bonds over the lattice's
//   viscosity=1                                   over that of Fig. 1
//   strain-x=1.3 strain-y=1.8 breaking-stretch=3.05 toughening=1.6
//   length=0.15 height=0.035                      [m]
//   seed=1 noise=0.05                             of the random displacements; amplitude over 0.625 mm
//   contact=1                                     distance over d; 0: flanks pass through each other
//   offset=0                                      of the seed crack from the middle [m]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/seed.h"
#include "lattice/simulation.h"

using namespace latcon::lattice;

namespace
{

struct Options
{
  Grid::Kind grid = Grid::Kind::triangular;
  Orientation orientation = Orientation::rows_along_crack;
  std::map<std::string, double> numbers{
    {"m", 2.},           {"contact", 1.},   {"half-width", 30.}, {"horizon", 1.},
    {"viscosity", 1.},   {"strain-x", 1.3}, {"strain-y", 1.8},   {"breaking-stretch", 3.05},
    {"toughening", 1.6}, {"length", 0.15},  {"height", 0.035},   {"seed", 1.},
    {"noise", 0.05},     {"offset", 0.}};

  double operator[](const std::string &name) const { return numbers.at(name); }
};

Options read(int argc, char **argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string text = argv[i], name = text.substr(0, text.find('=')), value = text.substr(text.find('=') + 1);
    char *end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (text == "grid=square" || text == "grid=triangular")
      options.grid = value == "square" ? Grid::Kind::square : Grid::Kind::triangular;
    else if (text == "rows=along" || text == "rows=across")
      options.orientation = value == "along" ? Orientation::rows_along_crack : Orientation::rows_across_crack;
    else if (options.numbers.count(name) != 0 && name != text && !value.empty() && *end == '\0')
      options.numbers[name] = number;
    else
      throw std::invalid_argument("`" + text + "` is no option; the first lines of nonlocal_crack.cc list them");
  }
  return options;
}

void run(const Options &options)
{
  const double lattice_spacing = 0.625e-3, degree = M_PI / 180., d = lattice_spacing * options["horizon"];
  const double length = options["length"];
  const MooneyRivlinBond law(0.1e6, 0.15e6);
  const Material material{
    944., {law, 2. / 3., 65.625 * options["viscosity"]}, Shell{law, 4. / 3., 196.875 * options["viscosity"]}};
  const Grid grid{options.grid, d / options["m"], 0., options.orientation};
  const TriangularLattice sheet(
    grid, ring_stencil(grid, lattice_rings(d, options.orientation, options["half-width"] * degree)), d, length,
    options["height"]);
  const Eigen::Matrix2d F = Eigen::Vector2d(1. + options["strain-x"], 1. + options["strain-y"]).asDiagonal();
  State state = homogeneous_state(sheet, material, F, Edges::held);
  add_noise(state, sheet, options["noise"] * lattice_spacing, static_cast<std::uint64_t>(options["seed"]));
  const ContactLaw contact = contact_like_nearest_bond(sheet, material, std::max(options["contact"], 1e-3) * d, 1., 1.);
  // Stretches down to these are as in the cases of latcon.
  const TimeStepping stepping = chebyshev_time_stepping(chebyshev_step(sheet, material, 0.45, contact),
                                                        time_step_limits(sheet, material, 0.3, contact), 0);
  Simulation simulation(
    sheet, material, std::move(state), stepping,
    Fracture(sheet, material, options["breaking-stretch"], BehindTipToughening{8.5e-3, options["toughening"]}, F));
  if (options["contact"] > 0.)
    simulation.enable_contact(contact);
  // Between rows, whatever the grid.
  simulation.cut_bonds(bonds_across(sheet, length / 15., length / 7.5, options["offset"] + 0.25 * grid.spacing));
  std::printf("# %zu points, %zu half-bonds, %u stages a step of %.3g s\nt,X,Y\n", sheet.n_sites(), sheet.n_kinds(),
              stepping.stages, stepping.step);

  const double from = length / 3., to = 0.9 * length;
  std::vector<Eigen::Vector3d> path; // t, X, Y
  EnergyBalance at_start = simulation.energies();
  double tip = 0.;
  while (tip < to && simulation.state().time < 0.02)
  {
    simulation.step();
    const Eigen::Vector2d X = simulation.tip() ? sheet.reference(*simulation.tip()) : Eigen::Vector2d(0., 0.);
    if (X.x() <= tip)
      continue;
    tip = X.x();
    std::printf("%.9g,%.9g,%.9g\n", simulation.state().time, X.x(), X.y());
    if (tip < from)
      continue;
    if (path.empty())
      at_start = simulation.energies();
    path.emplace_back(simulation.state().time, X.x(), X.y());
  }
  if (path.size() < 3)
    throw std::runtime_error("the crack stopped at X = " + std::to_string(100. * tip) + " cm");

  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d &point : path)
    mean += point / static_cast<double>(path.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d &point : path)
    moments += (point - mean) * (point - mean).transpose() / static_cast<double>(path.size());
  const EnergyBalance end = simulation.energies();
  const double advance = path.back()[1] - path.front()[1];
  std::printf("# speed %.2f m/s, rms of the path %.3f mm, mean Y %.3f mm\n", moments(0, 1) / moments(0, 0),
              1e3 * std::sqrt(moments(2, 2)), 1e3 * mean[2]);
  std::printf("# kJ/m^2: viscous %.2f, broken %.2f; imbalance of the ledger %.1e\n",
              1e-3 * (end.viscous - at_start.viscous) / advance, 1e-3 * (end.broken - at_start.broken) / advance,
              end.imbalance() / (end.viscous + end.broken));
}

} // namespace

int main(int argc, char **argv)
{
  try
  {
    run(read(argc, argv));
    return 0;
  }
  catch (const std::invalid_argument &error)
  {
    std::fprintf(stderr, "nonlocal_crack: %s\n", error.what());
    return 2;
  }
  catch (const std::exception &error)
  {
    std::fprintf(stderr, "nonlocal_crack: %s\n", error.what());
    return 4;
  }
}
