#pragma once

#include <cmath>

#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

/// The motion on which orders of convergence are measured.
namespace smooth_motion
{

/// A held, stretched sheet set off by a smooth velocity field of a few m/s, after `steps` steps.
/// @param imbalance takes that of the energy ledger [J/m], if given
inline latcon::lattice::State run(const latcon::lattice::Material &material, latcon::lattice::TimeStepping stepping,
                                  std::size_t steps, double *imbalance = nullptr)
{
  using namespace latcon::lattice;
  const TriangularLattice sheet = sheets::square(12);
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, sheets::stretched(1.5, 1.4), Edges::held),
                        stepping);
  Field vx(sheet.n_places()), vy(sheet.n_places());
  for (std::size_t i = 0; i < vx.size(); ++i)
  {
    const Eigen::Vector2d X = sheet.reference(i) / sheets::spacing;
    vx[i] = 4. * std::sin(0.5 * X.x()) * std::cos(0.4 * X.y());
    vy[i] = 3. * std::cos(0.3 * X.x() + 0.5 * X.y());
  }
  simulation.set_velocities(vx, vy);
  for (std::size_t step = 0; step < steps; ++step)
    simulation.step();
  if (imbalance != nullptr)
    *imbalance = simulation.energies().imbalance();
  return simulation.state();
}

/// Between two states, over all positions [m].
inline double distance(const latcon::lattice::State &a, const latcon::lattice::State &b)
{
  double square = 0.;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    square += std::pow(a.x[i] - b.x[i], 2) + std::pow(a.y[i] - b.y[i], 2);
  return std::sqrt(square);
}

} // namespace smooth_motion
