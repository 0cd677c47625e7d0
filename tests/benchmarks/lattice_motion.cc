// Moves a sheet by a number of steps and prints what that took, as JSON: what whole programs are compared by.
//
// lattice_motion WORK SITES STEPS REPETITIONS THREADS STAGES [LAMMPS_DATA [POSITIONS]]
//   WORK         everything, nearest or linear
//   SITES        number of sites, about
//   STEPS        steps of a repetition; as many come before the first and are not timed
//   STAGES       of a step of Runge-Kutta-Chebyshev; 0: velocity Verlet
//   LAMMPS_DATA  file that gets the sheet as LAMMPS reads it, before it moves; linear bonds alone
//   POSITIONS    file that gets x and y of all sites [m] after each of these times, a site a line in the order of
//   LAMMPS
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <omp.h>
#include <sys/resource.h>

#include "tests/benchmarks/lammps_data.h"
#include "tests/benchmarks/sheets.h"

using namespace latcon;

namespace
{

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
      out << motion.simulation.state().x[place] << " " << motion.simulation.state().y[place] << "\n";
    }
}

/// @param positions gets them after each repetition, if it is open
nlohmann::ordered_json moved(benchmarks::Motion &motion, std::size_t steps, std::size_t repetitions,
                             std::ofstream &positions)
{
  const auto advance = [&]
  {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t step = 0; step < steps; ++step)
      motion.simulation.step();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    if (positions.is_open())
      write_positions(motion, positions);
    return taken.count();
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

int run(const std::vector<std::string> &arguments)
{
  if (arguments.size() < 6)
    throw std::invalid_argument("lattice_motion WORK SITES STEPS REPETITIONS THREADS STAGES [LAMMPS_DATA [POSITIONS]]");
  omp_set_num_threads(std::stoi(arguments[4]));
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
  std::cout << moved(motion, std::stoul(arguments[2]), std::stoul(arguments[3]), positions).dump() << "\n";
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
