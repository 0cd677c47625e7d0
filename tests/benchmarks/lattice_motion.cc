// Moves a sheet by a number of steps and prints what that took, as JSON. The instruction set is the best that the
// variable LATCON_INSTRUCTION_SET of the environment allows.
//
// lattice_motion WORK SITES STEPS REPETITIONS THREADS STAGES [LAMMPS_DATA [POSITIONS]]
//   WORK         see sheets.h; formulas: root, quotient and law of six bonds per site alone, STEPS times
//   SITES        number of sites, about
//   STEPS        steps of a repetition; as many come before the first and are not timed
//   STAGES       of a step of Runge-Kutta-Chebyshev; 0: velocity Verlet
//   LAMMPS_DATA  file that gets the sheet as LAMMPS reads it, before it moves; linear bonds alone
//   POSITIONS    file that gets x and y of all sites [m] after each of these times, a site a line in the order of
//   LAMMPS
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <omp.h>
#include <sys/resource.h>

#include "tests/benchmarks/bond_formulas.h"
#include "tests/benchmarks/lammps_data.h"
#include "tests/benchmarks/sheets.h"

using namespace latcon;

namespace
{

// Time of a number of calls [s].
template <class Call>
double seconds_of(std::size_t n, const Call &call)
{
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < n; ++i)
    call();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return taken.count();
}

// From and to arrays that fit into the first-level cache, by the instruction set of the steps: a lower bound of a step,
// which also gathers, moves and monitors.
nlohmann::ordered_json formulas(std::size_t steps, std::size_t repetitions)
{
  constexpr std::size_t sites = 64, n = 6 * sites;
  const lattice::MooneyRivlinBond law(1e5, 1.5e5);
  const lattice::kernels::BondConstants bond{sheets::spacing, 4e-4, 0.07};
  std::vector<double> dx(n), dy(n), dvx(n), dvy(n), fx(n), fy(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double angle = 0.1 * static_cast<double>(i);
    dx[i] = 1.5e-3 * std::cos(angle);
    dy[i] = 1.2e-3 * std::sin(angle);
    dvx[i] = std::sin(3. * angle);
    dvy[i] = std::cos(5. * angle);
  }
  double power = 0.;
  const auto call = [&]
  {
    power =
      lattice::kernels::bond_formulas(law, bond, n, dx.data(), dy.data(), dvx.data(), dvy.data(), fx.data(), fy.data());
  };
  seconds_of(steps, call);
  std::vector<double> seconds;
  for (std::size_t i = 0; i < repetitions; ++i)
    seconds.push_back(seconds_of(steps, call));
  double expected = 0.;
  bool agrees = true;
  for (std::size_t i = 0; i < n; ++i)
  {
    const double length = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]), inverse = 1. / length;
    const double nx = dx[i] * inverse, ny = dy[i] * inverse, rate = dvx[i] * nx + dvy[i] * ny;
    const double stretch = (1. / bond.rest_length) * length, viscous = bond.damping * rate;
    const double axial =
      bond.cross_section * lattice::formulas::force(law, stretch, bond.rest_length * inverse) + viscous;
    agrees = agrees && fx[i] == axial * nx && fy[i] == axial * ny;
    expected += viscous * rate;
  }
  if (!agrees || !(std::abs(power - expected) <= n * std::numeric_limits<double>::epsilon() * expected))
    throw std::runtime_error("forces differ from those of single bonds");
  return {{"sites", sites}, {"steps", steps}, {"seconds", seconds}};
}

double peak_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024. * static_cast<double>(usage.ru_maxrss); // Linux counts in kibibytes
}

void write_positions(const benchmarks::Motion &motion, std::ofstream &out)
{
  const lattice::TriangularLattice &sheet = motion.sheet;
  out.precision(17);
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      out << motion.simulation.state().position.x[place] << " " << motion.simulation.state().position.y[place] << "\n";
    }
}

/// @param positions gets them after each repetition, if it is open
nlohmann::ordered_json moved(benchmarks::Motion &motion, std::size_t steps, std::size_t repetitions,
                             std::ofstream &positions)
{
  const auto advance = [&]
  {
    const double taken = seconds_of(steps, [&] { motion.simulation.step(); });
    if (positions.is_open())
      write_positions(motion, positions);
    return taken;
  };
  advance();
  std::vector<double> seconds;
  for (std::size_t i = 0; i < repetitions; ++i)
    seconds.push_back(advance());
  const lattice::EnergyBalance energies = motion.simulation.energies();
  return {{"sites", motion.sheet.n_sites()},
          {"columns", motion.sheet.columns()},
          {"steps", steps},
          {"time_step", motion.simulation.time_step()},
          {"seconds", seconds},
          {"potential_energy", energies.elastic},
          {"kinetic_energy", energies.kinetic},
          {"broken", motion.simulation.n_broken()},
          {"peak_memory_bytes", peak_memory()}};
}

void print(nlohmann::ordered_json result)
{
  result["instruction_sets"] = lattice::kernels::instruction_sets();
  std::cout << result.dump() << "\n";
}

int run(const std::vector<std::string> &arguments)
{
  if (arguments.size() < 6)
    throw std::invalid_argument("lattice_motion WORK SITES STEPS REPETITIONS THREADS STAGES [LAMMPS_DATA [POSITIONS]]");
  omp_set_num_threads(std::stoi(arguments[4]));
  const std::size_t steps = std::stoul(arguments[2]), repetitions = std::stoul(arguments[3]);
  if (arguments[0] == "formulas")
  {
    print(formulas(steps, repetitions));
    return 0;
  }
  const benchmarks::Work work = benchmarks::work_of(arguments[0]);
  benchmarks::Motion motion(work, std::stod(arguments[1]), static_cast<unsigned int>(std::stoul(arguments[5])));
  if (arguments.size() > 6)
  {
    if (work != benchmarks::Work::linear)
      throw std::invalid_argument("LAMMPS' bonds are the linear ones");
    benchmarks::write_lammps_data(motion.simulation, arguments[6]);
  }
  std::ofstream positions;
  if (arguments.size() > 7)
    positions.open(arguments[7]);
  print(moved(motion, steps, repetitions, positions));
  if (positions.is_open() && !positions.flush())
    throw std::runtime_error("cannot write " + arguments[7]);
  return 0;
}

} // namespace

int main(int argc, char **argv)
{
  try
  {
    return run({argv + 1, argv + argc});
  }
  catch (const std::exception &error)
  {
    std::cerr << "lattice_motion: " << error.what() << "\n";
    return 2;
  }
}
